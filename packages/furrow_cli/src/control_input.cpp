#include "control_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <string_view>
#include <utility>

namespace furrow::cli {
namespace {

constexpr int kBackgroundPoll_ms = 200;

/// To read a terminal from the background would stop the process.
bool in_background() {
  return ::isatty(STDIN_FILENO) == 1 && ::tcgetpgrp(STDIN_FILENO) != ::getpgrp();
}

}  // namespace

ControlInput::ControlInput(std::function<void(const std::string&)> on_line) {
  if (::pipe(wake_) != 0) return;
  thread_ = std::thread([this, on_line = std::move(on_line)] { run(on_line); });
}

ControlInput::~ControlInput() {
  if (!thread_.joinable()) return;
  ::close(wake_[1]);
  thread_.join();
  ::close(wake_[0]);
}

void ControlInput::run(const std::function<void(const std::string&)>& on_line) const {
  constexpr std::size_t kMaxLine = 1000;
  std::string line;
  while (true) {
    pollfd waiting[2] = {{STDIN_FILENO, POLLIN, 0}, {wake_[0], POLLIN, 0}};
    if (::poll(waiting, 2, -1) < 0) continue;
    if (waiting[1].revents != 0) return;
    if (in_background()) {
      ::poll(&waiting[1], 1, kBackgroundPoll_ms);
      continue;
    }
    char bytes[256];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) return;
    for (const char c : std::string_view(bytes, static_cast<std::size_t>(count))) {
      if (c != '\n') {
        if (line.size() < kMaxLine) line += c;
        continue;
      }
      on_line(line);
      line.clear();
    }
  }
}

}  // namespace furrow::cli
