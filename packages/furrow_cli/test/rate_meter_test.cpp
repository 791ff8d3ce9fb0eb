#include "rate_meter.hpp"

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

Time at(double seconds) {
  return Time::from_seconds(seconds);
}

TEST(RateMeter, CountsMessagesAndBytesAfterTheFirst) {
  RateMeter meter(Duration::seconds(10.0));
  meter.add(at(0.0), 1000);
  EXPECT_FALSE(meter.rate().has_value());
  meter.add(at(0.5), 100);
  meter.add(at(1.0), 300);
  const auto rate = meter.rate();
  ASSERT_TRUE(rate.has_value());
  EXPECT_DOUBLE_EQ(rate->hz, 2.0);
  EXPECT_DOUBLE_EQ(rate->bytes_per_s, 400.0);
  EXPECT_DOUBLE_EQ(rate->mean_bytes, 200.0);
  EXPECT_DOUBLE_EQ(rate->span_s, 1.0);
}

TEST(RateMeter, ForgetsWhatIsOlderThanTheWindow) {
  RateMeter meter(Duration::seconds(1.0));
  for (const double time_s : {0.0, 0.1, 0.2, 5.0, 5.25, 5.5}) meter.add(at(time_s), 1);
  ASSERT_TRUE(meter.rate().has_value());
  EXPECT_DOUBLE_EQ(meter.rate()->hz, 4.0);
}

TEST(RateMeter, TellsThatTheWindowIsShorterThanThePeriod) {
  RateMeter meter(Duration::seconds(0.1));
  meter.add(at(0.0), 1);
  meter.add(at(0.5), 1);
  EXPECT_FALSE(meter.period_beyond_window().has_value());
  meter.add(at(1.0), 1);
  ASSERT_TRUE(meter.period_beyond_window().has_value());
  EXPECT_DOUBLE_EQ(meter.period_beyond_window()->to_seconds(), 0.5);
}

TEST(RateMeter, APauseIsNoPeriod) {
  RateMeter meter(Duration::seconds(0.1));
  for (const double time_s : {0.0, 0.05, 3.0, 6.0, 9.0}) meter.add(at(time_s), 1);
  EXPECT_FALSE(meter.rate().has_value());
  EXPECT_FALSE(meter.period_beyond_window().has_value());
}

}  // namespace
}  // namespace furrow::cli
