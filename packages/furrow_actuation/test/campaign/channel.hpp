#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation::campaign {

enum class ChannelFault { kNone, kLost, kLate, kReordered, kDuplicated, kNotFinite, kFrozen };

/// A topic from one sender to one receiver, with the fault that it has at the moment.
template <class Message>
class Channel {
 public:
  Channel(Random& random, std::function<void(Message&)> spoil)
      : random_(random), spoil_(std::move(spoil)) {}

  void set_fault(ChannelFault fault) {
    fault_ = fault;
    frozen_.reset();
  }

  void send(Time now, Message message) {
    Time due = now;
    switch (fault_) {
      case ChannelFault::kNone:
        break;
      case ChannelFault::kLost:
        if (random_.bernoulli(0.9)) return;
        break;
      case ChannelFault::kLate:
        due += Duration::seconds(random_.uniform(0.05, 0.6));
        break;
      case ChannelFault::kReordered:
        due += Duration::seconds(random_.uniform(0.0, 0.15));
        break;
      case ChannelFault::kDuplicated:
        queue_.push_back({now + Duration::seconds(random_.uniform(0.0, 0.3)), message});
        break;
      case ChannelFault::kNotFinite:
        spoil_(message);
        break;
      case ChannelFault::kFrozen:
        if (!frozen_) frozen_ = message;
        message = *frozen_;
        break;
    }
    queue_.push_back({due, std::move(message)});
  }

  /// Delivers what has arrived, in the order of arrival. A receiver that does not call loses all
  /// but the newest `depth` messages.
  void receive(Time now, const std::function<void(const Message&)>& take, std::size_t depth = 10) {
    std::stable_sort(queue_.begin(), queue_.end(),
                     [](const auto& a, const auto& b) { return a.due < b.due; });
    std::vector<Message> arrived;
    while (!queue_.empty() && queue_.front().due <= now) {
      arrived.push_back(std::move(queue_.front().message));
      queue_.pop_front();
    }
    const std::size_t first = arrived.size() > depth ? arrived.size() - depth : 0;
    for (std::size_t i = first; i < arrived.size(); ++i) take(arrived[i]);
  }

 private:
  struct Entry {
    Time due;
    Message message;
  };
  Random& random_;
  std::function<void(Message&)> spoil_;
  ChannelFault fault_ = ChannelFault::kNone;
  std::optional<Message> frozen_;
  std::deque<Entry> queue_;
};

}  // namespace furrow::actuation::campaign
