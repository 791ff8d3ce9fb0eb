#include "furrow_supervisor/resume_policy.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "furrow_msgs/furrow_msgs.h"

namespace furrow::supervisor {
namespace {

using msgs::SafetyCause;

furrow_msgs::msg::AxisState state(const std::string& axis,
                                  std::initializer_list<SafetyCause> latched) {
  furrow_msgs::msg::AxisState state;
  state.axis(axis);
  for (const SafetyCause cause : latched) state.latched().push_back(msgs::to_msg(cause));
  return state;
}

constexpr ResumePolicy::Clock::time_point kResumeStart{std::chrono::seconds(100)};

TEST(ResumePolicy, ResetsLostPeersByAxisAndCauseAndNothingElse) {
  ResumePolicy policy;
  policy.take(state("axis_1", {SafetyCause::kPeerLost, SafetyCause::kValveFault}));
  policy.take(state("axis_2", {SafetyCause::kEmergencyStop, SafetyCause::kDriveFault}));
  policy.take(state("axis_3", {}));
  const auto resets = policy.due(kResumeStart);
  ASSERT_EQ(resets.size(), 1u);
  EXPECT_EQ(resets[0].axis(), "axis_1");
  EXPECT_EQ(resets[0].cause(), SafetyCause::kPeerLost);
}

TEST(ResumePolicy, EveryCauseButThoseOfALostPeerIsLeftToAPerson) {
  const std::initializer_list<SafetyCause> lost = {SafetyCause::kPeerLost, SafetyCause::kPlanStale,
                                                   SafetyCause::kTracksStale,
                                                   SafetyCause::kOdometryStale};
  for (std::uint8_t value = 1; value < 16; ++value) {
    furrow_msgs::msg::SafetyCause wire;
    wire.value(value);
    const auto cause = msgs::from_msg(wire);
    ASSERT_TRUE(cause.ok()) << int{value};
    ResumePolicy policy;
    policy.take(state("axis_1", {*cause}));
    const bool resets = !policy.due(kResumeStart).empty();
    EXPECT_EQ(resets, std::ranges::find(lost, *cause) != lost.end()) << msgs::to_string(*cause);
  }
}

TEST(ResumePolicy, AsksOnceASecondAndStopsWhenTheCauseIsReset) {
  ResumePolicy policy;
  policy.take(state("axis_1", {SafetyCause::kPlanStale}));
  EXPECT_EQ(policy.due(kResumeStart).size(), 1u);
  EXPECT_TRUE(policy.due(kResumeStart + std::chrono::milliseconds(900)).empty());
  EXPECT_EQ(policy.due(kResumeStart + std::chrono::milliseconds(1100)).size(), 1u);
  policy.take(state("axis_1", {}));
  EXPECT_TRUE(policy.due(kResumeStart + std::chrono::seconds(5)).empty());
}

}  // namespace
}  // namespace furrow::supervisor
