#pragma once

#include <functional>
#include <thread>

namespace furrow::cli {

/// Calls back on a thread of its own when SIGINT or SIGTERM comes, while it lives. Make it before
/// any other thread: they inherit the blocked signals.
class SignalWatch {
 public:
  explicit SignalWatch(std::function<void()> on_signal);
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  std::thread thread_;
};

}  // namespace furrow::cli
