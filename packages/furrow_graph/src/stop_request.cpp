#include "stop_request.hpp"

namespace furrow::graph {

void StopRequest::set(std::string_view reason, bool failed) {
  {
    const MutexLock lock(mutex_);
    if (requested_) return;
    reason_ = reason;
    failed_ = failed;
    requested_ = true;
  }
  set_.notify_all();
}

RunResult StopRequest::result(Time end) const {
  const MutexLock lock(mutex_);
  return {reason_, failed_, end};
}

bool StopRequest::wait_until(std::chrono::steady_clock::time_point deadline) {
  const MutexLock lock(mutex_);
  while (!requested_ && set_.wait_until(mutex_, deadline)) {
  }
  return requested_;
}

void StopRequest::wait() {
  const MutexLock lock(mutex_);
  while (!requested_) set_.wait(mutex_);
}

}  // namespace furrow::graph
