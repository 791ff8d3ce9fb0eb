#include "furrow_supervisor/child_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
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

TEST(ChildProcess, ASignalBeforeItsProgramRunsIsNotHandledByTheParentsHandler) {
  // The handler tells by an inherited pipe, as that of the supervisor does.
  static std::array<int, 2> told{};
  ASSERT_EQ(pipe2(told.data(), O_NONBLOCK | O_CLOEXEC), 0);
  const auto previous = std::signal(SIGTERM, [](int) { (void)!write(told[1], "x", 1); });
  for (int i = 0; i < 50; ++i) {
    auto child = ChildProcess::start({"/bin/sleep", "60"});
    ASSERT_TRUE(child.ok());
    ASSERT_EQ(kill(child->pid(), SIGTERM), 0);
    const int status = end_of(*child);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
    char text = 0;
    ASSERT_EQ(read(told[0], &text, 1), -1) << "the child ran the handler of its parent";
  }
  std::signal(SIGTERM, previous);
  close(told[0]);
  close(told[1]);
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
