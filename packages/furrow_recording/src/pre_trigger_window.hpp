#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "furrow_core/time.hpp"
#include "furrow_recording/latched_messages.hpp"

namespace furrow::recording {

/// The last messages before a trigger, bounded in time and bytes.
class PreTriggerWindow {
 public:
  PreTriggerWindow(Duration length, std::uint64_t max_bytes)
      : length_(length), max_bytes_(max_bytes) {}

  /// Adds a message; those that leave the window go to `expire`, the oldest first.
  void add(KeptMessage message, const std::function<void(KeptMessage)>& expire) {
    const Time oldest = message.log_time - length_;
    bytes_ += message.payload->size();
    messages_.push_back(std::move(message));
    while (!messages_.empty() && (messages_.front().log_time < oldest || bytes_ > max_bytes_)) {
      expire(take_oldest());
    }
  }
  /// @pre not empty().
  KeptMessage take_oldest() {
    KeptMessage message = std::move(messages_.front());
    messages_.pop_front();
    bytes_ -= message.payload->size();
    return message;
  }
  void clear() {
    messages_.clear();
    bytes_ = 0;
  }
  [[nodiscard]] bool empty() const { return messages_.empty(); }
  [[nodiscard]] std::size_t size() const { return messages_.size(); }
  /// @pre not empty().
  [[nodiscard]] Time begin() const { return messages_.front().log_time; }

 private:
  Duration length_;
  std::uint64_t max_bytes_;
  std::deque<KeptMessage> messages_;
  std::uint64_t bytes_ = 0;
};

}  // namespace furrow::recording
