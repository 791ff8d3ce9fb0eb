#include "furrow_supervisor/child_process.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace furrow::supervisor {
namespace {

/// Waits for the end of the process; its wait status.
int end_of(ChildProcess& child) {
  int status = 0;
  while (!child.ended(status)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return status;
}

TEST(ChildProcess, StandardErrorComesThroughItsOutput) {
  auto child = ChildProcess::start({"/bin/sh", "-c", "echo text >&2; exit 3"});
  ASSERT_TRUE(child.ok()) << child.error().message;
  const int status = end_of(*child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  char text[16] = {};
  EXPECT_EQ(read(child->output(), text, sizeof text), 5);
  EXPECT_STREQ(text, "text\n");
}

TEST(ChildProcess, IsSentSignals) {
  auto child = ChildProcess::start({"/bin/sleep", "60"});
  ASSERT_TRUE(child.ok());
  child->send(SIGTERM);
  const int status = end_of(*child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

TEST(ChildProcess, IsKilledWithItsObject) {
  pid_t pid = 0;
  {
    auto child = ChildProcess::start({"/bin/sleep", "60"});
    ASSERT_TRUE(child.ok());
    pid = child->pid();
    ASSERT_EQ(kill(pid, 0), 0);
  }
  EXPECT_EQ(kill(pid, 0), -1);
}

TEST(ChildProcess, ProgramThatIsNotThereEndsWith127) {
  auto child = ChildProcess::start({"/nonexistent/program"});
  ASSERT_TRUE(child.ok());
  const int status = end_of(*child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 127);
}

}  // namespace
}  // namespace furrow::supervisor
