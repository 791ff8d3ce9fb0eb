#include "furrow_launch/signals.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>

namespace furrow::launch {
namespace {

using namespace std::chrono_literals;

/// Counts calls from another thread, and waits for them.
class Calls {
 public:
  void add(int call) {
    const std::lock_guard lock(mutex_);
    last_ = call;
    changed_.notify_all();
  }
  /// False when it does not come within ten seconds.
  bool wait_for(int call) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 10s, [&] { return last_ >= call; });
  }
  int last() {
    const std::lock_guard lock(mutex_);
    return last_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int last_ = 0;
};

TEST(SignalPipe, KeepsSignalsUntilTheyAreTaken) {
  const SignalPipe pipe({SIGUSR1, SIGTERM});
  EXPECT_EQ(pipe.take(), 0);
  raise(SIGTERM);
  raise(SIGUSR1);
  EXPECT_EQ(pipe.take(), SIGTERM);
  EXPECT_EQ(pipe.take(), SIGUSR1);
  EXPECT_EQ(pipe.take(), 0);
}

TEST(SignalPipe, ForgetsAndRestoresAtItsEnd) {
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGUSR1, nullptr, &before), 0);
  {
    const SignalPipe pipe({SIGUSR1});
    raise(SIGUSR1);
  }
  struct sigaction after {};
  ASSERT_EQ(sigaction(SIGUSR1, nullptr, &after), 0);
  EXPECT_EQ(after.sa_handler, before.sa_handler);
  const SignalPipe next({SIGUSR1});
  EXPECT_EQ(next.take(), 0);
}

// A handler that was entered on another thread may write after the object is gone. It must then
// meet the pipe, not a descriptor that was opened since.
TEST(SignalPipe, DescriptorOutlivesTheObject) {
  int fd = -1;
  {
    const SignalPipe pipe({SIGUSR1});
    fd = pipe.fd();
  }
  const int opened = dup(STDIN_FILENO);
  EXPECT_NE(opened, fd);
  close(opened);
  const SignalPipe next({SIGUSR1});
  EXPECT_EQ(next.fd(), fd);
}

TEST(SignalWatch, CallsBackForSignalsThatCameBeforeIt) {
  SignalPipe pipe({SIGINT, SIGTERM});
  raise(SIGINT);
  Calls calls;
  const SignalWatch watch(pipe, [&calls](int call) { calls.add(call); });
  EXPECT_TRUE(calls.wait_for(1));
  raise(SIGTERM);
  EXPECT_TRUE(calls.wait_for(2));
}

TEST(SignalWatch, RepeatsAFirstSignalThatIsNotObeyed) {
  SignalPipe pipe({SIGINT});
  Calls calls;
  const SignalWatch watch(
      pipe, [&calls](int call) { calls.add(call); }, 1ms);
  raise(SIGINT);
  EXPECT_TRUE(calls.wait_for(2));
}

TEST(SignalWatch, NeverCallsBackAfterItsEnd) {
  SignalPipe pipe({SIGINT});
  for (int i = 0; i < 200; ++i) {
    auto alive = std::make_unique<Calls>();
    {
      const SignalWatch watch(pipe, [&](int call) { alive->add(call); });
      raise(SIGINT);
    }
    alive.reset();  // the address sanitizer sees a call that comes later
  }
  EXPECT_LE(pipe.take(), SIGINT);
}

}  // namespace
}  // namespace furrow::launch
