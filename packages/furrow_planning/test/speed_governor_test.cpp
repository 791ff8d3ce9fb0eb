#include "furrow_planning/speed_governor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"
#include "furrow_planning/observation_view.hpp"

namespace furrow::planning {
namespace {

constexpr double kRow_mps = 0.5;
constexpr double kFront_m = 0.2;
constexpr double kRear_m = -0.2;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A weed that is left where the robot is faster than `up_to_mps` anywhere beside it, from before
/// the foremost axis meets it until the hindmost has passed it.
struct Weed {
  double x_m = 0.0;
  double up_to_mps = 0.0;
  double weight = 1.0;
};

/// Stands for the planner: what is left of these weeds, by x.
struct Weeds {
  std::vector<Weed> weeds;
  std::vector<LeftTarget> left;
  int asked = 0;

  LeftAtSpeeds left_at() {
    return [this](const SpeedProfile& speeds) -> Result<std::span<const LeftTarget>> {
      ++asked;
      left.clear();
      for (const Weed& weed : weeds) {
        double fastest_mps = 0.0;
        for (double x_m = weed.x_m - kFront_m; x_m <= weed.x_m - kRear_m; x_m += 0.005) {
          fastest_mps = std::max(fastest_mps, speeds.speed_mps(x_m));
        }
        if (fastest_mps > weed.up_to_mps + 1e-9) left.push_back({weed.x_m, weed.weight});
      }
      return std::span<const LeftTarget>(left);
    };
  }
};

SpeedGovernorParameters parameters() {
  return {.min_speed_mps = 0.2,
          .speed_step_mps = 0.1,
          .acceleration_mps2 = 0.3,
          .lead_m = 0.1,
          .tolerated_weight = 0.0,
          .most_planned_targets = 1200};
}

GovernedRobot at(double x_m, double speed_mps = kRow_mps) {
  return {.x_m = x_m, .speed_mps = speed_mps, .committed_until_x_m = x_m, .targets = 1};
}

SpeedGovernor governor_for(Weeds& weeds, const SpeedGovernorParameters& p = parameters()) {
  SpeedGovernor governor(p, kRow_mps, kFront_m, kRear_m);
  EXPECT_TRUE(governor.consider(at(0.0), weeds.left_at()).ok());
  return governor;
}

TEST(SpeedGovernor, AsksForTheRowsSpeedBeforeItKnowsAnything) {
  const SpeedGovernor governor(parameters(), kRow_mps, kFront_m, kRear_m);
  EXPECT_EQ(governor.request_mps(3.0), kRow_mps);
  EXPECT_EQ(governor.expected().speed_mps(3.0), kRow_mps);
}

TEST(SpeedGovernor, KeepsTheRowsSpeedWhereNothingIsLeft) {
  Weeds weeds{.weeds = {{1.0, kRow_mps}}, .left = {}};
  const SpeedGovernor governor = governor_for(weeds);
  EXPECT_EQ(weeds.asked, 1) << "no slower speed need be tried";
  for (const double x_m : {0.0, 0.8, 1.0, 5.0}) EXPECT_EQ(governor.request_mps(x_m), kRow_mps);
}

TEST(SpeedGovernor, IsSlowBesideAWeedAndBrakesAndAcceleratesAroundIt) {
  Weeds weeds{.weeds = {{1.5, 0.3}}, .left = {}};
  const SpeedGovernor governor = governor_for(weeds);
  const double from_m = 1.5 - kFront_m - 0.1;
  const double to_m = 1.5 - kRear_m;
  for (const double x_m : {from_m, from_m + 0.1, to_m}) {
    EXPECT_NEAR(governor.request_mps(x_m), 0.3, 1e-9) << x_m;
  }
  // v^2 = 0.3^2 + 2 a d: 0.4 m/s at 0.07 / 0.6 m before it and behind it, the row's at 0.16 / 0.6;
  // all to a step of the profile.
  EXPECT_NEAR(governor.request_mps(from_m - 0.07 / 0.6), 0.4, 0.01);
  EXPECT_NEAR(governor.request_mps(to_m + 0.07 / 0.6), 0.4, 0.01);
  EXPECT_NEAR(governor.request_mps(from_m - 0.18 / 0.6), kRow_mps, 1e-9);
  EXPECT_NEAR(governor.request_mps(to_m + 0.18 / 0.6), kRow_mps, 1e-9);
}

TEST(SpeedGovernor, ASpeedBetweenTwoStepsIsTakenDownToTheNextOne) {
  Weeds weeds{.weeds = {{1.5, 0.35}}, .left = {}};
  EXPECT_NEAR(governor_for(weeds).request_mps(1.5), 0.3, 1e-9);
}

TEST(SpeedGovernor, TheLastStepEndsAtTheLeastSpeed) {
  SpeedGovernorParameters p = parameters();
  p.min_speed_mps = 0.25;
  Weeds weeds{.weeds = {{1.5, 0.26}}, .left = {}};
  EXPECT_NEAR(governor_for(weeds, p).request_mps(1.5), 0.25, 1e-9);
}

TEST(SpeedGovernor, WhatNoSpeedSavesSlowsNothing) {
  Weeds weeds{.weeds = {{0.9, 0.1}, {2.0, 0.4}}, .left = {}};
  const SpeedGovernor governor = governor_for(weeds);
  EXPECT_EQ(governor.request_mps(0.9), kRow_mps);
  EXPECT_NEAR(governor.request_mps(2.0), 0.4, 1e-9);
}

TEST(SpeedGovernor, ToleratesThatLittleIsLeft) {
  Weeds weeds{.weeds = {{0.6, 0.4, 0.1}, {0.7, 0.4, 0.1}, {2.0, 0.3, 0.1}}, .left = {}};
  SpeedGovernorParameters p = parameters();
  p.tolerated_weight = 0.2;
  const SpeedGovernor governor = governor_for(weeds, p);
  EXPECT_EQ(governor.request_mps(0.7), kRow_mps) << "the first two together are tolerated";
  EXPECT_NEAR(governor.request_mps(2.0), 0.3, 1e-9);
}

TEST(SpeedGovernor, WhatItCannotBrakeForInTimeSlowsNothingButBrakingNeverJumps) {
  Weeds weeds{.weeds = {{0.25, 0.3}, {0.4, 0.45}}, .left = {}};
  const SpeedGovernor governor = governor_for(weeds);
  EXPECT_EQ(governor.request_mps(0.0), kRow_mps);
  EXPECT_NEAR(governor.request_mps(0.1), std::sqrt(0.25 - 0.6 * 0.1), 1e-3) << "for the second";
  EXPECT_NEAR(governor.request_mps(0.3), 0.4, 1e-9);
}

TEST(SpeedGovernor, DoesNotAccelerateBeforeTheLastSprayThatIsFixed) {
  Weeds weeds{.weeds = {{1.0, 0.2}}, .left = {}};
  SpeedGovernor governor = governor_for(weeds);
  const double slow_m = 1.0;
  ASSERT_NEAR(governor.request_mps(slow_m), 0.2, 1e-9);
  weeds.weeds.clear();  // committed, so that it is no longer asked about
  GovernedRobot robot = at(slow_m, 0.2);
  robot.committed_until_x_m = slow_m + 0.15;
  ASSERT_TRUE(governor.consider(robot, weeds.left_at()).ok());
  EXPECT_NEAR(governor.request_mps(slow_m + 0.15), 0.2, 1e-9);
  EXPECT_NEAR(governor.request_mps(slow_m + 0.25), std::sqrt(0.04 + 0.6 * 0.1), 0.02);
}

TEST(SpeedGovernor, PlansForTheSpeedThatTheRobotReallyHas) {
  Weeds weeds{.weeds = {{0.5, 0.3}}, .left = {}};
  SpeedGovernor governor = governor_for(weeds);
  ASSERT_NEAR(governor.request_mps(0.5), 0.3, 1e-9);
  // It does not brake.
  ASSERT_TRUE(governor.consider(at(0.5, kRow_mps), weeds.left_at()).ok());
  for (const double x_m : {0.5, 0.6, 1.5}) {
    EXPECT_NEAR(governor.expected().speed_mps(x_m), kRow_mps, 1e-9) << x_m;
  }
  // One that is slower than asked is not relied upon to stay so.
  ASSERT_TRUE(governor.consider(at(0.5, 0.1), weeds.left_at()).ok());
  EXPECT_EQ(governor.expected().speed_mps(0.5), governor.request_mps(0.5));
}

TEST(SpeedGovernor, WhatCannotBeUsedLeavesTheSpeedsAsTheyWere) {
  Weeds weeds{.weeds = {{1.5, 0.3}}, .left = {}};
  SpeedGovernor governor = governor_for(weeds);
  const auto fails = [](const SpeedProfile&) -> Result<std::span<const LeftTarget>> {
    return Error{ErrorCode::kUnavailable, "no"};
  };
  EXPECT_FALSE(governor.consider(at(0.0), fails).ok());
  Weeds none;
  EXPECT_FALSE(governor.consider(at(kNan), none.left_at()).ok());
  EXPECT_FALSE(governor.consider(at(0.0, kNan), none.left_at()).ok());
  EXPECT_NEAR(governor.request_mps(1.5), 0.3, 1e-9);
  EXPECT_TRUE(governor.consider(at(0.0), none.left_at()).ok());
  EXPECT_EQ(governor.request_mps(1.5), kRow_mps);
}

TEST(SpeedGovernor, TriesABoundedNumberOfPlans) {
  Weeds weeds;
  for (int i = 0; i < 200; ++i) weeds.weeds.push_back({0.5 + 0.01 * i, 0.2 + 0.001 * i});
  SpeedGovernorParameters p = parameters();
  p.speed_step_mps = 0.005;
  // Beside the plan for the least speed: 1200 targets in all, but two plans at least.
  for (const auto& [targets, plans] : {std::pair{100, 12}, std::pair{10'000, 2}}) {
    SpeedGovernor governor(p, kRow_mps, kFront_m, kRear_m);
    GovernedRobot robot = at(0.0);
    robot.targets = targets;
    weeds.asked = 0;
    ASSERT_TRUE(governor.consider(robot, weeds.left_at()).ok());
    EXPECT_EQ(weeds.asked, plans + 1);
  }
}

TEST(SpeedGovernor, RefusesParametersThatAreNotSound) {
  const auto with = [](auto change) {
    SpeedGovernorParameters p = parameters();
    change(p);
    return p;
  };
  using P = SpeedGovernorParameters;
  for (const P& p :
       {with([](P& x) { x.min_speed_mps = 0.0; }),
        with([](P& x) { x.min_speed_mps = kRow_mps + 0.1; }),
        with([](P& x) { x.min_speed_mps = kNan; }), with([](P& x) { x.speed_step_mps = 0.0; }),
        with([](P& x) { x.acceleration_mps2 = -1.0; }), with([](P& x) { x.lead_m = -0.1; }),
        with([](P& x) { x.tolerated_weight = kNan; })}) {
    EXPECT_THROW(SpeedGovernor(p, kRow_mps, kFront_m, kRear_m), ConfigError);
  }
  EXPECT_THROW(SpeedGovernor(parameters(), kNan, kFront_m, kRear_m), ConfigError);
  EXPECT_THROW(SpeedGovernor(parameters(), kRow_mps, kNan, kRear_m), ConfigError);
  EXPECT_THROW(SpeedGovernor(parameters(), kRow_mps, kRear_m, kFront_m), ConfigError);
}

TEST(SpeedGovernor, WithTheLeastSpeedAsTheRowsItAsksForThat) {
  SpeedGovernorParameters p = parameters();
  p.min_speed_mps = kRow_mps;
  Weeds weeds{.weeds = {{1.0, 0.1}}, .left = {}};
  EXPECT_EQ(governor_for(weeds, p).request_mps(1.0), kRow_mps);
}

class RandomWeeds : public testing::TestWithParam<int> {};

// A robot that does as it is asked, past weeds that it sees 1.2 m ahead, each with a speed of its
// own up to which it is treated.
TEST_P(RandomWeeds, AreMetSlowlyEnoughAndTheSpeedChangesGently) {
  const SpeedGovernorParameters p = parameters();
  Random random(static_cast<std::uint64_t>(GetParam()));
  Weeds field;
  for (double x_m = 1.5; x_m < 12.0; x_m += random.uniform(0.01, 1.0)) {
    field.weeds.push_back({x_m, random.uniform(p.min_speed_mps, 0.7)});
  }
  SpeedGovernor governor(p, kRow_mps, kFront_m, kRear_m);
  Weeds seen;
  double base_m = 0.0;
  double speed_mps = kRow_mps;
  for (int step = 0; base_m < 13.0; ++step) {
    if (step % 10 == 0) {
      seen.weeds.clear();
      for (const Weed& weed : field.weeds) {
        const double ahead_m = weed.x_m - base_m;
        if (ahead_m > kRear_m && ahead_m < kFront_m + 1.2) seen.weeds.push_back(weed);
      }
      ASSERT_TRUE(governor.consider(at(base_m, speed_mps), seen.left_at()).ok());
    }
    const double asked_mps = governor.request_mps(base_m);
    EXPECT_LE(std::abs(asked_mps - speed_mps), 1.1 * p.acceleration_mps2 * 0.02);
    EXPECT_GE(asked_mps, p.min_speed_mps - 1e-12);
    EXPECT_LE(asked_mps, kRow_mps + 1e-12);
    speed_mps = asked_mps;
    base_m += speed_mps * 0.02;
    for (const Weed& weed : field.weeds) {
      const double ahead_m = weed.x_m - base_m;
      if (ahead_m > kRear_m && ahead_m < kFront_m) {
        EXPECT_LE(speed_mps, std::min(kRow_mps, weed.up_to_mps) + 0.01) << weed.x_m;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomWeeds, testing::Range(1, 21));

struct Drive {
  double loss = 0.0;
  double mean_mps = 0.0;
  int late = 0;  ///< sprays for which the axis had no time
};

/// The last spray of an axis.
struct Made {
  double time_s = -10.0;
  double position_m = 0.0;
};

/// Notes the sprays of a robot that drove from one place to the other in 20 ms. Counts the sprays
/// that their axis cannot have reached since its last one: a dwell of 10 ms and a move from rest to
/// rest at 50 m/s2 below 5 m/s, with a tolerance of 5 ms.
int note_sprays(const ObservationView& view, double from_m, double to_m, double time_s,
                std::vector<Made>& made) {
  int late = 0;
  for (std::size_t a = 0; a < made.size(); ++a) {
    for (const Stop& stop : view.plan().routes[a]) {
      if (stop.robot_x_m <= from_m || stop.robot_x_m > to_m) continue;
      const Made spray{time_s + 0.02 * (stop.robot_x_m - from_m) / (to_m - from_m),
                       stop.position_m};
      const double way_m = std::abs(spray.position_m - made[a].position_m);
      const double needed_s =
          0.01 + (way_m < 0.5 ? 2.0 * std::sqrt(way_m / 50.0) : way_m / 5.0 + 0.1);
      late += spray.time_s - made[a].time_s < needed_s - 0.005 ? 1 : 0;
      made[a] = spray;
    }
  }
  return late;
}

/// Four axes with the times of real ones over a dense field; the robot does as it is asked.
Drive drive(bool governed, double row_mps, std::uint64_t seed) {
  constexpr double kLength_m = 8.0;
  constexpr double kAhead_m = 1.3;
  PlannerParameters planner;
  planner.kinematics = "trapezoid";
  planner.speed_mps = row_mps;
  planner.dwell_s = 0.01;
  planner.settle_s = 0.025;
  planner.rho = 0.5;
  planner.commit_s = 0.3;
  std::vector<AxisSpec> axes;
  for (const double offset_m : {0.18, 0.06, -0.06, -0.18}) axes.push_back({.offset_x_m = offset_m});
  const auto view = make_observation_view(planner, axes);
  Random random(seed);
  std::vector<Target> field;
  const auto count = static_cast<int>(22.3 * kLength_m * 1.39);
  for (int i = 0; i < count; ++i) {
    field.push_back(
        {.id = i, .p_F = {random.uniform(0.0, kLength_m), random.uniform(-0.695, 0.695)}});
  }
  std::ranges::sort(field, {}, [](const Target& target) { return target.p_F.x(); });
  std::size_t next = 0;
  SpeedGovernor governor({}, row_mps, 0.18, -0.18);
  double x_m = -1.5;
  double time_s = 0.0;
  double time_all_s = 0.0;
  std::vector<Made> made(4);
  int late = 0;
  for (int step = 0; x_m < kLength_m + 0.5; ++step) {
    if (step % 10 == 0) {
      const double speed_mps = governor.request_mps(x_m);
      EXPECT_TRUE(view->advance({.x_m = x_m, .speed_mps = speed_mps}, x_m + kAhead_m).ok());
      for (; next < field.size() && field[next].p_F.x() < x_m + 0.18 + kAhead_m; ++next) {
        EXPECT_TRUE(view->update(field[next]).ok());
      }
      if (governed) {
        EXPECT_TRUE(governor
                        .consider({x_m, speed_mps, view->committed_until_x_m(),
                                   std::ssize(view->plan().decisions)},
                                  [&](const SpeedProfile& speeds) { return view->left_at(speeds); })
                        .ok());
        EXPECT_TRUE(view->set_speeds(governor.expected()).ok());
      }
      EXPECT_TRUE(view->replan().ok());
    }
    const double from_m = x_m;
    x_m += 0.02 * governor.request_mps(x_m);
    late += note_sprays(*view, from_m, x_m, time_all_s, made);
    time_all_s += 0.02;
    if (x_m > 0.0 && x_m < kLength_m) time_s += 0.02;
  }
  std::vector<TargetOutcome> outcomes;
  view->take_outcomes(outcomes);
  EXPECT_EQ(outcomes.size(), field.size());
  const auto treated = std::ranges::count(outcomes, Decision::kTreat, &TargetOutcome::decision);
  return {1.0 - static_cast<double>(treated) / count, kLength_m / time_s, late};
}

TEST(SpeedGovernor, SavesMostOfWhatARobotAtConstantSpeedLeaves) {
  double constant = 0.0;
  double governed = 0.0;
  double slow = 0.0;
  double mean_mps = 0.0;
  constexpr int kSeeds = 4;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto s = static_cast<std::uint64_t>(seed);
    constant += drive(false, 0.5, s).loss / kSeeds;
    const Drive asked = drive(true, 0.5, s);
    governed += asked.loss / kSeeds;
    mean_mps += asked.mean_mps / kSeeds;
    EXPECT_EQ(asked.late, 0) << "what is planned is in time while the speed changes";
    slow += drive(false, 0.4, s).loss / kSeeds;
  }
  EXPECT_GT(constant, 0.02);
  EXPECT_LT(governed, 0.3 * constant);
  EXPECT_LT(governed, slow) << "less than at a constant 0.4 m/s";
  EXPECT_GT(mean_mps, 0.4) << "and faster";
}

}  // namespace
}  // namespace furrow::planning
