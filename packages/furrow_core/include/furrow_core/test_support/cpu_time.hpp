#pragma once

#include <gtest/gtest.h>

#include <ctime>

namespace furrow {

/// For tests only: how long the calling thread computed, in s. Other work on the machine hardly
/// counts, so that ratios of it hold on a busy machine.
inline double thread_cpu_s() {
  timespec time{};
  EXPECT_EQ(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time), 0);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace furrow
