#include "furrow_launch/signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <utility>

namespace furrow::launch {
namespace {

// A signal handler reaches nothing but globals. Both are set once and stay.
std::atomic<int> write_end = -1;
std::atomic<int> read_end = -1;

void note(int signal) {
  const int kept = errno;
  const auto byte = static_cast<unsigned char>(signal);
  if (::write(write_end.load(), &byte, 1) < 0) {
    // A full pipe holds signals enough.
  }
  errno = kept;
}

void open_pipe(int (&ends)[2], int flags) {
  if (::pipe2(ends, flags) != 0) throw std::runtime_error("no pipe for signals");
}

void open_signal_pipe() {
  if (write_end >= 0) return;
  int ends[2];
  open_pipe(ends, O_CLOEXEC | O_NONBLOCK);
  read_end = ends[0];
  write_end = ends[1];
}

}  // namespace

SignalPipe::SignalPipe(std::initializer_list<int> signals) {
  open_signal_pipe();
  for (const int signal : signals) {
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, &before_[signal]);
  }
}

SignalPipe::~SignalPipe() {
  for (const auto& [signal, action] : before_) ::sigaction(signal, &action, nullptr);
  while (take() != 0) {
  }
}

int SignalPipe::fd() const {
  return read_end;
}

int SignalPipe::take() const {
  unsigned char signal = 0;
  return ::read(read_end, &signal, 1) == 1 ? signal : 0;
}

SignalWatch::SignalWatch(SignalPipe& pipe, std::function<void(int)> on_signal,
                         std::chrono::milliseconds patience)
    : pipe_(pipe) {
  open_pipe(wake_, O_CLOEXEC);
  thread_ =
      std::thread([this, on_signal = std::move(on_signal), patience] { run(on_signal, patience); });
}

SignalWatch::~SignalWatch() {
  ::close(wake_[1]);
  thread_.join();
  ::close(wake_[0]);
}

void SignalWatch::run(const std::function<void(int)>& on_signal,
                      std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  pollfd waiting[2] = {{pipe_.fd(), POLLIN, 0}, {wake_[0], POLLIN, 0}};
  int calls = 0;
  Clock::time_point deadline;
  while (true) {
    const bool waits_for_end = calls == 1 && patience.count() > 0;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    const int timeout_ms = waits_for_end ? static_cast<int>(std::max<std::int64_t>(0, left)) : -1;
    const int ready = ::poll(waiting, 2, timeout_ms);
    if (ready < 0) continue;
    if (waiting[1].revents != 0) return;
    bool again = ready == 0;  // patience is over
    while (pipe_.take() != 0) again = true;
    if (!again) continue;
    on_signal(++calls);
    deadline = Clock::now() + patience;
  }
}

}  // namespace furrow::launch
