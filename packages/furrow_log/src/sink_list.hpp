#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "furrow_log/log.hpp"

namespace furrow::log {

/// The sinks of a log. Thread-safe; calls one sink at a time.
class SinkList {
 public:
  void add(std::shared_ptr<Sink> sink);
  /// On return the sink is not called any more.
  void remove(const Sink& sink);
  void write(std::span<const Line> lines);
  void flush();
  /// Lines that a sink could not write.
  [[nodiscard]] std::uint64_t failed() const { return failed_; }

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<Sink>> sinks_;
  std::atomic<std::uint64_t> failed_ = 0;
};

}  // namespace furrow::log
