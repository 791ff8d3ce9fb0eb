#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "furrow_core/mutex.hpp"
#include "furrow_graph/runtime.hpp"

namespace furrow::graph {

/// Reason and failure of the first stop that was requested. Thread-safe.
class StopRequest {
 public:
  /// Later requests have no effect.
  void set(std::string_view reason, bool failed);
  [[nodiscard]] bool requested() const { return requested_; }
  [[nodiscard]] RunResult result(Time end) const;

  /// Returns at `deadline`, or when a stop is requested: then true.
  [[nodiscard]] bool wait_until(std::chrono::steady_clock::time_point deadline);
  void wait();

 private:
  mutable Mutex mutex_;
  ConditionVariable set_;
  std::atomic<bool> requested_ = false;
  std::string reason_ FURROW_GUARDED_BY(mutex_);
  bool failed_ FURROW_GUARDED_BY(mutex_) = false;
};

}  // namespace furrow::graph
