#include "furrow_core/time.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Time, SecondsRoundToNanoseconds) {
  EXPECT_EQ(Duration::seconds(0.1).count_ns(), 100'000'000);
  EXPECT_EQ(Duration::seconds(-1e-9).count_ns(), -1);
  EXPECT_EQ(Time::from_seconds(1.5).count_ns(), 1'500'000'000);
}

TEST(Time, Arithmetic) {
  const Time start = Time::from_nanoseconds(10);
  const Duration step = Duration::nanoseconds(3);
  EXPECT_EQ((start + step * 2) - start, Duration::nanoseconds(6));
  EXPECT_LT(start - step, start);
  EXPECT_EQ(-step + step, Duration());
}

}  // namespace
}  // namespace furrow
