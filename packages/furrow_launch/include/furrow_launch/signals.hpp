#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <initializer_list>
#include <map>
#include <thread>

namespace furrow::launch {

/// Keeps the signals that come, until they are read. A signal handler writes each into a pipe, so
/// that it does not matter which thread the system interrupts; blocking signals would not do,
/// because libraries start threads before main(). The pipe itself lives as long as the process, so
/// that a handler that still runs on another thread never meets a closed descriptor. One object at
/// a time in a process; use from one thread.
class SignalPipe {
 public:
  explicit SignalPipe(std::initializer_list<int> signals);
  /// Restores what the signals did before. Signals that were not read are discarded.
  ~SignalPipe();
  SignalPipe(const SignalPipe&) = delete;
  SignalPipe& operator=(const SignalPipe&) = delete;

  /// A descriptor to poll for reading.
  [[nodiscard]] int fd() const;
  /// The next signal that came; 0 when there is none.
  [[nodiscard]] int take() const;

 private:
  std::map<int, struct sigaction> before_;
};

/// Calls back from its own thread when SIGINT or SIGTERM comes. Construct it after the object that
/// the callback uses: the destructor joins the thread, so the callback never meets a destroyed
/// object. Signals that came earlier wait in the SignalPipe and are not lost.
class SignalWatch {
 public:
  /// `on_signal` gets the number of the call, from 1. A first signal that does not lead to the end
  /// of the watch within `patience` counts as a second one; zero: never.
  SignalWatch(SignalPipe& pipe, std::function<void(int call)> on_signal,
              std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  void run(const std::function<void(int)>& on_signal, std::chrono::milliseconds patience);
  SignalPipe& pipe_;
  int wake_[2] = {-1, -1};
  std::thread thread_;
};

}  // namespace furrow::launch
