#include "../src/rate_limit.hpp"

#include <gtest/gtest.h>

namespace furrow::log {
namespace {

constexpr int kPlenty = 1000;

Time after(double seconds) {
  return Time::from_seconds(seconds);
}

TEST(RateLimit, SameTextIsWrittenOncePerPeriodWithItsCount) {
  RateLimit limit(Duration::seconds(5.0), kPlenty);
  EXPECT_EQ(limit.admit(after(0.0), Level::kWarn, "no pose"), 0u);
  for (int i = 1; i < 50; ++i) {
    EXPECT_FALSE(limit.admit(after(0.1 * i), Level::kWarn, "no pose").has_value()) << i;
  }
  EXPECT_EQ(limit.admit(after(5.0), Level::kWarn, "no pose"), 49u);
  EXPECT_TRUE(limit.take_suppressed().empty());
}

TEST(RateLimit, TextsThatDifferInNumbersOnlyAreTheSame) {
  RateLimit limit(Duration::seconds(5.0), kPlenty);
  EXPECT_TRUE(limit.admit(after(0.0), Level::kWarn, "no plant in 31 images").has_value());
  EXPECT_FALSE(limit.admit(after(1.0), Level::kWarn, "no plant in 102 images").has_value());
  EXPECT_TRUE(limit.admit(after(1.0), Level::kWarn, "no plant in an image").has_value());
  EXPECT_TRUE(limit.admit(after(1.0), Level::kError, "no plant in 9 images").has_value());
}

TEST(RateLimit, SuppressedTextIsToldWithItsNewestWording) {
  RateLimit limit(Duration::seconds(5.0), kPlenty);
  (void)limit.admit(after(0.0), Level::kWarn, "1 lost");
  (void)limit.admit(after(1.0), Level::kWarn, "2 lost");
  (void)limit.admit(after(2.0), Level::kWarn, "3 lost");
  const auto left = limit.take_suppressed();
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].message, "3 lost");
  EXPECT_EQ(left[0].count, 2u);
  EXPECT_EQ(left[0].level, Level::kWarn);
}

TEST(RateLimit, ManyDifferentTextsAreLimitedPerSecond) {
  RateLimit limit(Duration::seconds(5.0), 3);
  int written = 0;
  std::string text = "a";
  for (int i = 0; i < 10; ++i, text += "a") {
    written += limit.admit(after(1.0), Level::kInfo, text).has_value() ? 1 : 0;
  }
  EXPECT_EQ(written, 3);
  EXPECT_EQ(limit.take_excess(after(1.5)), 0u) << "the second is not over";
  EXPECT_EQ(limit.take_excess(after(2.0)), 7u);
  EXPECT_TRUE(limit.admit(after(2.0), Level::kInfo, text).has_value());
}

TEST(RateLimit, ClockThatIsSetBackSilencesNoText) {
  RateLimit limit(Duration::seconds(5.0), kPlenty);
  EXPECT_TRUE(limit.admit(after(100.0), Level::kWarn, "x").has_value());
  EXPECT_TRUE(limit.admit(after(10.0), Level::kWarn, "x").has_value());
}

TEST(RateLimit, ForgottenTextsStayCounted) {
  RateLimit limit(Duration::seconds(1000.0), kPlenty);
  (void)limit.admit(after(0.0), Level::kWarn, "first");
  (void)limit.admit(after(0.5), Level::kWarn, "first");
  std::string text = "t";
  for (std::size_t i = 0; i < RateLimit::kMaxTexts; ++i, text += "t") {
    EXPECT_TRUE(limit.admit(after(1.0), Level::kWarn, text).has_value());
  }
  EXPECT_EQ(limit.take_excess(after(3.0)), 1u);
}

}  // namespace
}  // namespace furrow::log
