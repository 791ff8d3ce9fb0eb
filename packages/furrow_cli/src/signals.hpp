#pragma once

#include <functional>
#include <initializer_list>
#include <thread>

namespace furrow::cli {

/// Signals as numbers that are read from a pipe, whichever thread the system interrupts: libraries
/// start threads of their own before main(), where nothing can be blocked. One at a time in a
/// process.
class SignalPipe {
 public:
  explicit SignalPipe(std::initializer_list<int> signals);
  /// The signals do again what they did before.
  ~SignalPipe();
  SignalPipe(const SignalPipe&) = delete;
  SignalPipe& operator=(const SignalPipe&) = delete;

  /// To be polled for reading.
  [[nodiscard]] int fd() const { return ends_[0]; }
  /// The next signal that came; 0 when there is none.
  [[nodiscard]] int take() const;

 private:
  int ends_[2] = {-1, -1};
};

/// Calls back on a thread of its own when SIGINT or SIGTERM comes, while it lives.
class SignalWatch {
 public:
  explicit SignalWatch(std::function<void()> on_signal);
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  SignalPipe pipe_;
  int wake_[2] = {-1, -1};
  std::thread thread_;
};

}  // namespace furrow::cli
