#include "furrow_supervisor/restart_policy.hpp"

#include <gtest/gtest.h>

namespace furrow::supervisor {
namespace {

constexpr Time kStart = Time::from_nanoseconds(5'000'000'000);

TEST(RestartPolicy, WaitsTwiceAsLongEachTimeAndThenGivesUp) {
  RestartPolicy policy;
  Duration expected = RestartPolicy::kFirstDelay;
  for (int death = 0; death < RestartPolicy::kLimit; ++death) {
    const auto again = policy.after_death(kStart);
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(*again - kStart, std::min(expected, RestartPolicy::kLongestDelay));
    expected = expected * 2;
  }
  EXPECT_FALSE(policy.after_death(kStart).has_value());
}

TEST(RestartPolicy, ForgetsWhatIsLongAgo) {
  RestartPolicy policy;
  Time now = kStart;
  for (int death = 0; death < 20; ++death) {
    const auto again = policy.after_death(now);
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(*again - now, RestartPolicy::kFirstDelay);
    now += RestartPolicy::kWindow + Duration::milliseconds(1);
  }
}

}  // namespace
}  // namespace furrow::supervisor
