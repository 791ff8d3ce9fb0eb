#include "../src/lateness.hpp"

#include <gtest/gtest.h>

namespace furrow::graph {
namespace {

Duration us(std::int64_t microseconds) {
  return Duration::nanoseconds(1000 * microseconds);
}

TEST(LatenessHistogram, RoundsQuantilesUpToABin) {
  LatenessHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), Duration());
  for (int i = 1; i <= 1000; ++i) histogram.add(us(i));
  EXPECT_EQ(histogram.count(), 1000u);
  EXPECT_NEAR(histogram.quantile(0.5).to_seconds(), 500e-6, 10.5e-6);
  EXPECT_NEAR(histogram.quantile(0.99).to_seconds(), 990e-6, 10.5e-6);
  EXPECT_EQ(histogram.quantile(1.0), us(1000));
  EXPECT_EQ(histogram.max(), us(1000));
}

TEST(LatenessHistogram, ReportsTheMaximumBeyondTheBins) {
  LatenessHistogram histogram;
  histogram.add(us(5));
  histogram.add(Duration::milliseconds(70));
  histogram.add(Duration::milliseconds(90));
  EXPECT_EQ(histogram.quantile(0.3), us(10));
  EXPECT_EQ(histogram.quantile(0.9), Duration::milliseconds(90));
  histogram.add(Duration::milliseconds(-1));  // an early call counts as punctual
  EXPECT_EQ(histogram.quantile(0.25), us(10));
}

}  // namespace
}  // namespace furrow::graph
