#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "furrow_dds/test_domain.hpp"

namespace furrow::dds {

/// Runs `program DOMAIN` and kills it at the end. If the test dies, the program's standard input
/// ends, and so does the program.
class PeerProcess {
 public:
  explicit PeerProcess(std::string program) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    std::string domain = std::to_string(test_domain());
    char* arguments[] = {program.data(), domain.data(), nullptr};
    started_ = posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    input_ = ends[1];
    EXPECT_TRUE(started_) << program;
  }
  ~PeerProcess() {
    end();
    close(input_);
  }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  void signal(int number) const { kill(pid_, number); }
  void end() {
    if (!started_) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    started_ = false;
  }

 private:
  pid_t pid_ = 0;
  int input_ = -1;
  bool started_ = false;
};

}  // namespace furrow::dds
