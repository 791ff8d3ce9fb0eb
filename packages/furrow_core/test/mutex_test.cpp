#include "furrow_core/mutex.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace furrow {
namespace {

TEST(MutexLock, ReleasesTheMutexAtTheEndOfItsScope) {
  Mutex mutex;
  {
    MutexLock lock(mutex);
    lock.unlock();
    std::thread other([&] { const MutexLock held(mutex); });
    other.join();
    lock.lock();
  }
  const MutexLock again(mutex);
}

TEST(ConditionVariable, WakesAWaitingThreadThatThenHoldsTheMutex) {
  Mutex mutex;
  ConditionVariable changed;
  int turn = 0;
  std::thread other([&] {
    MutexLock lock(mutex);
    while (turn != 1) changed.wait(mutex);
    turn = 2;
    changed.notify_one();
  });
  {
    MutexLock lock(mutex);
    turn = 1;
    changed.notify_one();
    while (turn != 2) changed.wait(mutex);
  }
  other.join();
  EXPECT_EQ(turn, 2);
}

TEST(ConditionVariable, ReportsAPassedDeadline) {
  Mutex mutex;
  ConditionVariable never;
  const MutexLock lock(mutex);
  EXPECT_FALSE(never.wait_until(mutex, std::chrono::steady_clock::now()));
}

}  // namespace
}  // namespace furrow
