#include "signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <map>
#include <stdexcept>
#include <utility>

namespace furrow::cli {
namespace {

// What a signal handler can reach: there is no other way to it than a global.
std::atomic<int> note_to = -1;
std::map<int, struct sigaction> before;

void note(int signal) {
  const int kept = errno;
  const auto byte = static_cast<unsigned char>(signal);
  if (::write(note_to.load(), &byte, 1) < 0) {
    // A full pipe tells of signals enough.
  }
  errno = kept;
}

void open_pipe(int (&ends)[2], int flags) {
  if (::pipe2(ends, flags) != 0) throw std::runtime_error("no pipe for signals");
}

}  // namespace

SignalPipe::SignalPipe(std::initializer_list<int> signals) {
  open_pipe(ends_, O_CLOEXEC | O_NONBLOCK);
  note_to = ends_[1];
  for (const int signal : signals) {
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, &before[signal]);
  }
}

SignalPipe::~SignalPipe() {
  for (const auto& [signal, action] : before) ::sigaction(signal, &action, nullptr);
  before.clear();
  note_to = -1;
  ::close(ends_[0]);
  ::close(ends_[1]);
}

int SignalPipe::take() const {
  unsigned char signal = 0;
  return ::read(ends_[0], &signal, 1) == 1 ? signal : 0;
}

SignalWatch::SignalWatch(std::function<void()> on_signal) : pipe_({SIGINT, SIGTERM}) {
  open_pipe(wake_, O_CLOEXEC);
  thread_ = std::thread([this, on_signal = std::move(on_signal)] {
    pollfd waiting[2] = {{pipe_.fd(), POLLIN, 0}, {wake_[0], POLLIN, 0}};
    while (true) {
      if (::poll(waiting, 2, -1) < 0) continue;
      if (waiting[1].revents != 0) return;
      while (pipe_.take() != 0) on_signal();
    }
  });
}

SignalWatch::~SignalWatch() {
  ::close(wake_[1]);
  thread_.join();
  ::close(wake_[0]);
}

}  // namespace furrow::cli
