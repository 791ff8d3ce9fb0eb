// Plans for a robot whose speed changes along the row.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"
#include "furrow_planning/observation_view.hpp"
#include "stream_field.hpp"

namespace furrow::planning {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class EachPlanner : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST(RollingView, SaysWhatOtherSpeedsWouldLeaveAndChangesNothing) {
  auto parameters = parameters_for("rolling", "footprint");
  parameters.kinematics = "trapezoid";
  const auto targets = field(40.0, 2.0, 9);
  const auto view_at = [&](const SpeedProfile& speeds) {
    auto view = make_observation_view(parameters, axes(3));
    EXPECT_TRUE(view->set_speeds(speeds).ok());
    EXPECT_TRUE(view->advance({.x_m = -0.5}, 2.0).ok());
    for (const Target& target : targets) EXPECT_TRUE(view->update(target).ok());
    EXPECT_TRUE(view->replan().ok());
    return view;
  };
  const SpeedProfile braking(-0.5, 0.5, {0.8, 0.6, 0.4, 0.3, 0.3});
  const auto slow = view_at(SpeedProfile::constant(0.3));
  const double weight = slow->plan().weight;
  std::vector<std::size_t> counts;
  for (const SpeedProfile& speeds :
       {SpeedProfile::constant(0.3), braking, SpeedProfile::constant(0.8)}) {
    const auto left = slow->left_at(speeds);
    ASSERT_TRUE(left.ok()) << left.error().message;
    EXPECT_TRUE(std::ranges::is_sorted(*left, {}, &LeftTarget::x_m));
    counts.push_back(left->size());
    // As a view at those speeds plans it, and checks.
    const auto other = view_at(speeds);
    const auto unreachable = std::ranges::count(other->plan().decisions, Decision::kUnreachable,
                                                &TargetDecision::decision);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(left->size()), unreachable);
    EXPECT_EQ(slow->plan().weight, weight);
    EXPECT_FALSE(slow->replan().value()) << "nothing changed";
  }
  EXPECT_LT(counts[0], counts[1]);
  EXPECT_LT(counts[1], counts[2]);
}

TEST_P(EachPlanner, AConstantProfileGivesThePlanOfThatSpeed) {
  const auto [planner, assignment] = GetParam();
  auto parameters = parameters_for("rolling", planner, assignment);
  parameters.speed_source = "measured";
  const auto targets = field(30.0, 2.0, 10);
  const auto plan_at = [&](bool profile) {
    const auto view = make_observation_view(parameters, axes(3));
    if (profile) {
      EXPECT_TRUE(view->set_speeds(SpeedProfile(-1.0, 0.3, {0.7, 0.7, 0.7})).ok());
    }
    EXPECT_TRUE(view->advance({.x_m = -0.5, .speed_mps = 0.7}, 2.0).ok());
    for (const Target& target : targets) EXPECT_TRUE(view->update(target).ok());
    const auto replanned = view->replan();
    EXPECT_TRUE(replanned.ok()) << replanned.error().message;
    return view->plan();
  };
  const Plan by_speed = plan_at(false);
  const Plan by_profile = plan_at(true);
  EXPECT_EQ(by_profile.treated, by_speed.treated);
  for (std::size_t a = 0; a < by_speed.routes.size(); ++a) {
    ASSERT_EQ(by_profile.routes[a].size(), by_speed.routes[a].size());
    for (std::size_t s = 0; s < by_speed.routes[a].size(); ++s) {
      EXPECT_NEAR(by_profile.routes[a][s].depart_x_m, by_speed.routes[a][s].depart_x_m, 1e-9);
    }
  }
}

// The checker, which knows the profile but not how the planners use it, looks at every plan.
TEST_P(EachPlanner, PlansForSpeedsThatChangePassTheCheck) {
  const auto [planner, assignment] = GetParam();
  auto parameters = parameters_for("rolling", planner, assignment);
  parameters.kinematics = "trapezoid";
  Random random(11);
  for (std::uint64_t run = 0; run < 10; ++run) {
    std::vector<double> speeds;
    for (int i = 0; i < 30; ++i) speeds.push_back(random.uniform(0.1, 1.0));
    const auto view = make_observation_view(parameters, axes(4));
    ASSERT_TRUE(view->set_speeds(SpeedProfile(-0.5, 0.1, speeds)).ok());
    ASSERT_TRUE(view->advance({.x_m = -0.5}, 2.0).ok());
    for (const Target& target : field(30.0, 2.0, 20 + run)) {
      ASSERT_TRUE(view->update(target).ok());
    }
    const auto replanned = view->replan();
    ASSERT_TRUE(replanned.ok()) << replanned.error().message;
    EXPECT_GT(view->plan().weight, 0.0);
    EXPECT_LE(view->plan().weight, view->plan().weight_bound + 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Planners, EachPlanner,
                         testing::Values(std::pair{"greedy", "joint"}, std::pair{"notsp", "static"},
                                         std::pair{"permutation", "dynamic"},
                                         std::pair{"exact", "static"}, std::pair{"exact", "joint"},
                                         std::pair{"footprint", "joint"}));

TEST(RollingView, KnowsUntilWhereItIsCommitted) {
  auto parameters = parameters_for("rolling");
  parameters.commit_s = 0.2;
  const auto view = make_observation_view(parameters, axes(1));
  ASSERT_TRUE(view->set_speeds(SpeedProfile::constant(0.5)).ok());
  ASSERT_TRUE(view->advance({.x_m = 0.0}, 1.0).ok());
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.3, 0.0}}).ok());
  ASSERT_TRUE(view->replan().ok());
  EXPECT_EQ(view->committed_until_x_m(), 0.0);
  ASSERT_TRUE(view->advance({.x_m = 0.25}, 1.0).ok());
  EXPECT_DOUBLE_EQ(view->committed_until_x_m(), 0.3);
  ASSERT_TRUE(view->advance({.x_m = 0.35}, 1.0).ok());
  EXPECT_DOUBLE_EQ(view->committed_until_x_m(), 0.35);
}

TEST(View, PlansForSpeedsThatChangeOnlyInTheRollingViewAndAtRest) {
  const SpeedProfile speeds = SpeedProfile::constant(0.5);
  const auto rolling = make_observation_view(parameters_for("rolling"), axes(1));
  EXPECT_FALSE(rolling->left_at(speeds).ok()) << "the robot's place is not known yet";
  const auto segments = make_observation_view(parameters_for("segment"), axes(1));
  ASSERT_TRUE(segments->advance({.x_m = 0.0}, 1.0).ok());
  EXPECT_FALSE(segments->left_at(speeds).ok());
  EXPECT_FALSE(segments->set_speeds(speeds).ok());
  auto parameters = parameters_for("rolling", "footprint");
  parameters.fire_while_moving = true;
  const auto passing = make_observation_view(parameters, axes(1));
  ASSERT_TRUE(passing->advance({.x_m = 0.0}, 1.0).ok());
  EXPECT_FALSE(passing->left_at(speeds).ok());
  EXPECT_FALSE(passing->set_speeds(speeds).ok());
}

TEST(SpeedProfile, TellsTimesAndPlaces) {
  // From 0.5 m/s at 1 m to 0.3 at 2 m: 1 m at 0.4 on average; then held.
  const SpeedProfile profile(1.0, 1.0, {0.5, 0.3});
  EXPECT_DOUBLE_EQ(profile.speed_mps(0.0), 0.5);
  EXPECT_DOUBLE_EQ(profile.speed_mps(1.5), 0.4);
  EXPECT_DOUBLE_EQ(profile.speed_mps(9.0), 0.3);
  EXPECT_EQ(profile.greatest_mps(), 0.5);
  EXPECT_DOUBLE_EQ(profile.time_s(0.5), -1.0);
  EXPECT_DOUBLE_EQ(profile.time_s(2.0), 2.5);
  EXPECT_DOUBLE_EQ(profile.time_s(2.3), 3.5);
  for (const double x_m : {-3.0, 0.5, 1.0, 1.2, 1.99, 2.0, 2.3, 10.0}) {
    EXPECT_NEAR(profile.x_m(profile.time_s(x_m)), x_m, 1e-12);
  }
}

TEST(SpeedProfile, RefusesWhatIsNoSpeed) {
  EXPECT_THROW(SpeedProfile(0.0, 1.0, {}), ConfigError);
  EXPECT_THROW(SpeedProfile(kNan, 1.0, {0.5}), ConfigError);
  EXPECT_THROW(SpeedProfile(0.0, 0.0, {0.5}), ConfigError);
  for (const double speed_mps : {0.0, -0.1, kNan}) {
    EXPECT_THROW(SpeedProfile(0.0, 1.0, {0.5, speed_mps}), ConfigError);
  }
}

}  // namespace
}  // namespace furrow::planning
