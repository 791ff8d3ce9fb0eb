// Odometry whose stamps are of another clock, late or out of order: within its deadline it would
// put the robot elsewhere by its speed times the difference.

#include <gtest/gtest.h>

#include <algorithm>

#include "trip.hpp"

namespace furrow::actuation {
namespace {

using testing::paper_axis;
using testing::stop_at;
using testing::Trip;

constexpr double kSpeed_mps = 0.5;

/// A stop each 0.2 m from 0.4 m on.
std::vector<PlannedStop> many_stops() {
  std::vector<PlannedStop> stops;
  for (int i = 0; i < 20; ++i) stops.push_back(stop_at(i, {0.4 + 0.2 * i, 0.1}, {}));
  return stops;
}

double farthest_from_a_stop_m(const Trip& trip) {
  double farthest_m = 0.0;
  for (const auto& landed : trip.rig.landed()) {
    double nearest_m = 1e9;
    for (const PlannedStop& stop : trip.plan) {
      nearest_m = std::min(nearest_m, (landed.p_F - stop.p_F).norm());
    }
    farthest_m = std::max(farthest_m, nearest_m);
  }
  return farthest_m;
}

TEST(OdometryClock, AStepThatIsShorterThanTheDeadlineLeadsToTheSafeState) {
  const ToolSafetyParameters deadlines;
  for (const double step_s : {-0.09, -0.021, 0.021, 0.09}) {
    SCOPED_TRACE(step_s);
    ASSERT_LT(std::abs(step_s), deadlines.odometry_deadline_s);
    Trip trip;
    trip.plan = many_stops();
    trip.run(1.2);
    const std::size_t before = trip.rig.landed().size();
    ASSERT_GT(before, 1u);
    trip.rig.odometry_clock = Duration::seconds(step_s);
    trip.run(1.0);
    EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
    EXPECT_EQ(trip.axis().output.cause, SafetyCause::kOdometryStale);
    trip.reset();
    trip.run(1.0);
    EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);  // the clock is still off
    trip.rig.odometry_clock = {};
    trip.run(0.1);
    trip.reset();
    trip.run(1.5);
    EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
    EXPECT_GT(trip.rig.landed().size(), before + 2);
    // As without the step: half a cycle of valve and axis, at 0.5 m/s.
    EXPECT_LE(farthest_from_a_stop_m(trip), 0.002);
  }
}

TEST(OdometryClock, AShorterDifferenceMovesTheSprayBySpeedTimesDifference) {
  const ToolSafetyParameters limits;
  Trip trip;
  trip.plan = many_stops();
  trip.rig.odometry_clock = Duration::seconds(0.99 * limits.odometry_delay_limit_s);
  trip.run(2.0);
  EXPECT_EQ(trip.count(ControllerEventKind::kSafeState), 0);
  ASSERT_GT(trip.rig.landed().size(), 3u);
  EXPECT_NEAR(farthest_from_a_stop_m(trip), kSpeed_mps * limits.odometry_delay_limit_s, 0.002);
}

TEST(OdometryClock, OneLateOrReorderedMessageIsLeftOut) {
  AxisController controller(paper_axis(0), {}, {});
  const auto odometry = [](double stamp_s) {
    return BaseState{
        Time::from_seconds(stamp_s), {kSpeed_mps * stamp_s, 0.0, 0.0}, {0.5, 0.0, 0.0}};
  };
  const auto came = [&](double arrival_s, double stamp_s) {
    return controller.set_odometry(Time::from_seconds(arrival_s), odometry(stamp_s));
  };
  EXPECT_TRUE(came(10.001, 10.000));
  EXPECT_TRUE(came(10.021, 10.020));
  EXPECT_FALSE(came(10.022, 10.020));  // a duplicate
  EXPECT_FALSE(came(10.022, 10.010));  // overtaken
  EXPECT_FALSE(came(10.065, 10.040));  // late
  EXPECT_TRUE(came(10.066, 10.060));
}

TEST(OdometryClock, AStepBackOfTheDriversClockIsSurvived) {
  AxisController controller(paper_axis(0), {}, {});
  const auto came = [&](double time_s) {
    const Time now = Time::from_seconds(time_s);
    return controller.set_odometry(now, {now, {}, {kSpeed_mps, 0.0, 0.0}});
  };
  EXPECT_TRUE(came(5000.0));
  EXPECT_TRUE(came(1000.0));
}

}  // namespace
}  // namespace furrow::actuation
