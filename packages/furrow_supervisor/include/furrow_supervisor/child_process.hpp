#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::supervisor {

/// A program that was started. It has a process group of its own, so that a terminal's Ctrl-C
/// reaches it through its parent only, and gets SIGTERM when the parent is gone.
class ChildProcess {
 public:
  /// `command` is the program's path and its arguments. What it writes to stderr comes through
  /// output().
  [[nodiscard]] static Result<ChildProcess> start(const std::vector<std::string>& command);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  /// Kills and reaps it when it still runs.
  ~ChildProcess();

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Non-blocking end of the pipe.
  [[nodiscard]] int output() const { return output_; }
  void send(int signal) const;
  /// Reaps it when it has ended; its wait status.
  [[nodiscard]] bool ended(int& wait_status);

 private:
  ChildProcess(pid_t pid, int output) : pid_(pid), output_(output) {}
  pid_t pid_ = -1;
  int output_ = -1;
};

}  // namespace furrow::supervisor
