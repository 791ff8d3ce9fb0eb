#include "furrow_actuation/axis_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "allocation_counter.hpp"
#include "furrow_core/error.hpp"
#include "trip.hpp"

namespace furrow::actuation {
namespace {

using testing::paper_axis;
using testing::ready;
using testing::Rig;
using testing::steady;
using testing::stop_at;
using testing::Trip;

TEST(AxisController, SpraysItsStopsOnceAndReportsThem) {
  Trip trip;
  trip.plan = {stop_at(1, {0.6, 0.3}, {}), stop_at(2, {0.9, -0.4}, {}),
               stop_at(3, {1.0, -0.4}, {})};
  trip.plan[2].targets.push_back(4);
  trip.run(2.5);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 3);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayClosed), 3);
  EXPECT_EQ(trip.count(ControllerEventKind::kStopSkipped), 0);
  ASSERT_EQ(trip.rig.landed().size(), 3u);
  const ControllerEvent closed = trip.last(ControllerEventKind::kSprayClosed);
  EXPECT_EQ(closed.stop_id, 3);
  EXPECT_EQ(closed.targets.size(), 2u);
  EXPECT_EQ(closed.reason, SkipReason::kNone);
  EXPECT_LT((closed.p_F - trip.rig.landed()[2].p_F).norm(), 1e-3);
  EXPECT_LT((closed.p_F - Eigen::Vector2d(1.0, -0.4)).norm(), 2e-3);
  EXPECT_EQ(trip.axis().controller.use(trip.rig.now()).openings, 3);
  EXPECT_NEAR(trip.axis().controller.use(trip.rig.now()).open_s, 0.030, 1e-6);
  EXPECT_NEAR(trip.rig.landed()[0].seconds, 0.010, 1e-6);
}

TEST(AxisController, MovesToTheStopEarlyAndFiresAtRest) {
  Trip trip;
  trip.plan = {stop_at(1, {0.8, 0.5}, {})};
  trip.run(0.5);  // the stop is reached 1.24 s after the start
  EXPECT_NEAR(trip.rig.axis(0).driver.reading().position_m, 0.5, 1e-4);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 0);
}

TEST(AxisController, GoesOnFromTheDriveAfterCyclesWereLeftOut) {
  for (const int cycles : {4, 10, 20, 60}) {
    Trip trip;
    trip.plan = {stop_at(1, {0.8, 0.5}, {})};
    trip.run(0.06);
    ASSERT_GT(trip.axis().driver.reading().velocity_mps, 1.0);
    trip.rig.stall(cycles);
    trip.run(0.2);
    trip.reset();  // of what has become too old meanwhile
    trip.run(2.0);
    EXPECT_EQ(trip.axis().driver.reading().fault, DriveFault::kNone) << cycles;
    EXPECT_NE(trip.last(ControllerEventKind::kSafeState).cause, SafetyCause::kFollowingError);
    EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1) << cycles;
    EXPECT_LT((trip.last(ControllerEventKind::kSprayClosed).p_F - Eigen::Vector2d(0.8, 0.5)).norm(),
              2e-3);
  }
}

TEST(AxisController, PassingFiresOnTheMove) {
  Trip trip;
  trip.plan = {stop_at(1, {0.6, 0.1}, {}), stop_at(2, {0.8, 0.4}, {})};
  trip.plan[0].fire_while_moving = true;
  trip.run(2.0);
  ASSERT_EQ(trip.rig.landed().size(), 2u);
  EXPECT_LT((trip.rig.landed()[0].p_F - Eigen::Vector2d(0.6, 0.1)).norm(), 4e-3);
  const auto& droplets = trip.rig.landed()[0].droplets_F;
  // The spray is drawn out sideways by 10 ms at 0.5 m/s.
  EXPECT_NEAR(droplets.back().y() - droplets.front().y(), 0.005, 1e-3);
  EXPECT_LT((trip.rig.landed()[1].p_F - Eigen::Vector2d(0.8, 0.4)).norm(), 2e-3);
}

TEST(AxisController, ASprayWaitsForTheAxisToRestWhileItStillLandsNearEnough) {
  int waited = 0;
  int late = 0;
  for (int i = 0; i < 60; ++i) {
    Trip trip;
    const Eigen::Vector2d second_F(0.5 + 0.11 + 5e-4 * i, 0.3);
    trip.plan = {stop_at(1, {0.5, -0.3}, {}), stop_at(2, second_F, {})};
    trip.run(1.5);
    late += trip.count(ControllerEventKind::kStopSkipped);
    if (trip.rig.landed().size() < 2) continue;
    const testing::Landed& landed = trip.rig.landed()[1];
    const Eigen::Vector2d off_F = landed.p_F - second_F;
    EXPECT_LT(off_F.norm(), 0.009) << i;
    waited += off_F.x() > 0.003 ? 1 : 0;
    // At 0.05 m/s a drop is carried 2.5 mm aside while it falls.
    EXPECT_LT(std::abs(landed.droplets_F.back().y() - landed.droplets_F.front().y()), 0.003) << i;
  }
  EXPECT_GT(waited, 0);
  EXPECT_GT(late, 0);
  EXPECT_LT(late, 40);
}

TEST(AxisController, AnAxisThatDoesNotFollowItsSetpointSpraysNothing) {
  // Jammed near enough for the spray to land on its aim. When it comes free it moves at any speed.
  const AxisControllerParameters limits;
  for (const double short_m : {0.0005, 0.0065}) {
    Trip trip;
    trip.plan = {stop_at(1, {0.8, 0.3}, {})};
    const double jam_at_m = 0.3 - short_m;
    while (trip.axis().driver.reading().position_m < jam_at_m) trip.run(0.002);
    trip.axis().driver.set_jammed(true);
    const double off_m = 0.3 - trip.axis().driver.reading().position_m;
    ASSERT_LT(off_m, limits.placement_tolerance_m);
    trip.run(1.5);
    const bool settled = off_m <= limits.settled_error_m;
    EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), settled ? 1 : 0) << off_m;
    EXPECT_EQ(trip.count(ControllerEventKind::kStopSkipped), settled ? 0 : 1) << off_m;
    if (!settled) {
      EXPECT_GT(off_m, limits.settled_error_m);
      EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kLate);
    }
  }
}

TEST(AxisController, ASmallCorrectionShortBeforeASprayDoesNotMakeItLate) {
  // The stop at 0.8 m is due after some 1.2 s; a movement of 0.5 mm takes 20 ms.
  for (int cycles = 0; cycles < 30; ++cycles) {
    Trip trip;
    trip.plan = {stop_at(1, {0.8, 0.3}, {})};
    trip.run(1.16 + 0.002 * cycles);
    if (trip.count(ControllerEventKind::kSprayOpened) > 0) break;
    trip.plan = {stop_at(1, {0.8, 0.3005}, {})};
    trip.run(0.3);
    EXPECT_EQ(trip.count(ControllerEventKind::kStopSkipped), 0) << cycles;
    ASSERT_EQ(trip.rig.landed().size(), 1u) << cycles;
    EXPECT_LT((trip.rig.landed()[0].p_F - Eigen::Vector2d(0.8, 0.3005)).norm(), 0.009) << cycles;
    ASSERT_LT(cycles, 29) << "the spray never came due";
  }
}

TEST(AxisController, SkipsForEachReason) {
  {
    Trip trip;
    trip.plan = {stop_at(1, {0.5, -0.6}, {}), stop_at(2, {0.505, 0.6}, {})};
    trip.run(1.5);
    EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
    EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kLate);
    EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).stop_id, 2);
  }
  {
    Trip trip;
    trip.plan = {stop_at(1, {0.5, 0.9}, {}), stop_at(2, {0.6, 0.2}, {})};
    trip.run(1.5);
    EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
    EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kUnreachable);
    EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).stop_id, 1);
  }
  {
    AxisControllerParameters parameters;
    parameters.max_target_age_s = 0.5;
    Trip trip(parameters);
    trip.fresh = false;
    trip.plan = {stop_at(1, {1.0, 0.2}, {})};
    trip.run(2.0);
    EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 0);
    EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kStale);
  }
  {
    Trip trip;
    trip.plan = {stop_at(1, {0.6, 0.2}, {}), stop_at(2, {0.8, 0.2}, {})};
    trip.rig.crops = {{7, {0.62, 0.21}}};
    trip.run(1.5);
    EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
    EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kProtectedCrop);
    EXPECT_EQ(trip.count(ControllerEventKind::kStopSkipped), 1);
  }
}

TEST(AxisController, ACropSeenWhileSprayingClosesTheValve) {
  AxisControllerParameters parameters;
  parameters.dwell_s = 0.1;
  Trip trip(parameters);
  trip.plan = {stop_at(1, {0.6, 0.2}, {})};
  for (int i = 0; i < 2000 && !trip.axis().output.valve_open; ++i) trip.run(0.002);
  ASSERT_TRUE(trip.axis().output.valve_open);
  trip.rig.crops = {{7, {0.6, 0.21}}};
  trip.run(0.010);  // the next tracks
  EXPECT_FALSE(trip.axis().output.valve_open);
  EXPECT_EQ(trip.last(ControllerEventKind::kSprayClosed).reason, SkipReason::kProtectedCrop);
}

TEST(AxisController, AStandingOrReversingRobotSpraysNothing) {
  for (const double speed : {0.0, -0.3}) {
    Trip trip({}, [speed](double t) { return Twist2{t < 0.5 ? 0.5 : speed, 0.0, 0.0}; });
    trip.plan = {stop_at(1, {0.18 + 0.25, 0.2}, {}), stop_at(2, {0.3, 0.2}, {}),
                 stop_at(3, {0.18 + 0.25 + 0.001, 0.2}, {})};
    trip.run(0.5);
    trip.opened_now = false;
    trip.run(2.0);
    EXPECT_FALSE(trip.opened_now);
  }
  AxisControllerParameters parameters;
  parameters.dwell_s = 0.2;
  Trip trip(parameters, [](double t) { return Twist2{t < 0.7 ? 0.5 : 0.0, 0.0, 0.0}; });
  trip.plan = {stop_at(1, {0.18 + 0.35, 0.2}, {})};
  trip.run(1.5);
  EXPECT_EQ(trip.last(ControllerEventKind::kSprayClosed).reason, SkipReason::kStanding);
}

TEST(AxisController, DryRunMovesAndReportsButOpensNothing) {
  AxisControllerParameters parameters;
  parameters.dry_run = true;
  Trip trip(parameters);
  trip.plan = {stop_at(1, {0.6, 0.3}, {})};
  trip.run(1.5);
  EXPECT_FALSE(trip.opened_now);
  EXPECT_TRUE(trip.rig.landed().empty());
  EXPECT_EQ(trip.axis().controller.use(trip.rig.now()).openings, 0);
  EXPECT_TRUE(trip.last(ControllerEventKind::kSprayOpened).dry_run);
  EXPECT_NEAR(trip.rig.axis(0).driver.reading().position_m, 0.3, 1e-3);
}

TEST(AxisController, WaitsUntilEverythingIsThere) {
  SimulatedAxisParameters drive;
  Trip trip({}, steady, drive);
  trip.plan = {stop_at(1, {0.5, 0.2}, {}), stop_at(2, {2.0, 0.2}, {})};
  trip.axis().driver.set_connected({}, false);  // the drive is not there yet
  trip.run(1.0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kWaiting);
  EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kFault);
  EXPECT_EQ(trip.count(ControllerEventKind::kStopSkipped), 1);
  trip.axis().driver.set_connected(trip.rig.now(), true);
  trip.run(3.0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
  EXPECT_EQ(trip.count(ControllerEventKind::kSafeState), 0);
}

TEST(AxisController, RefusesBadPlansAndConfiguration) {
  AxisController controller(paper_axis(0), {}, {});
  std::vector<PlannedStop> many(kMaxPlanStops + 1, stop_at(1, {1.0, 0.0}, {}));
  EXPECT_EQ(controller.set_plan({}, many).error().code, ErrorCode::kOutOfRange);
  const std::vector<PlannedStop> bad{stop_at(1, {std::nan(""), 0.0}, {})};
  EXPECT_EQ(controller.set_plan({}, bad).error().code, ErrorCode::kInvalidArgument);
  const std::vector<PlannedStop> without_targets(1);
  EXPECT_EQ(controller.set_plan({}, without_targets).error().code, ErrorCode::kInvalidArgument);
  auto axis = paper_axis(0);
  axis.max_jerk_mps3 = 0.0;
  EXPECT_THROW(AxisController(axis, {}, {}), ConfigError);
  axis = paper_axis(0);
  axis.nozzle.height_m = 0.0;
  EXPECT_THROW(AxisController(axis, {}, {}), ConfigError);
  axis = paper_axis(0);
  axis.direction_B = {0.0, 0.0, 1.0};
  EXPECT_THROW(AxisController(axis, {}, {}), ConfigError);
}

TEST(AxisController, AllocatesNothingPerCycle) {
  AxisController controller(paper_axis(0), {}, {});
  SimulatedAxisDriver driver(MotionLimits::of(paper_axis(0)), ready());
  SimulatedValve valve({}, 1, "valve");
  std::vector<PlannedStop> plan;
  for (int i = 0; i < 40; ++i) {
    plan.push_back(stop_at(i, {0.5 + 0.3 * i, 0.5 * std::sin(2.0 * i)}, {}));
    plan.back().fire_while_moving = i % 3 == 0;
  }
  const std::vector<ProtectedPlant> crops(100, ProtectedPlant{1, {1.1, 0.45}});
  int opened = 0;
  int skipped = 0;
  const std::size_t before = testing::allocations();
  for (int i = 0; i < 10000; ++i) {
    const Time now = Time::from_nanoseconds(i * Rig::kPeriod.count_ns());
    const double x = 0.5 * now.to_seconds();
    const bool standing = i > 8000 && i < 8500;
    ASSERT_TRUE(driver.read(now, Rig::kPeriod).ok());
    controller.set_reading(now, driver.reading());
    controller.safety().heartbeat_came(now);
    controller.set_odometry(now, {now, {x, 0.0, 0.0}, {standing ? 0.0 : 0.5, 0.0, 0.02}});
    for (auto& stop : plan) stop.observed = now;
    ASSERT_TRUE(controller.set_plan(now, plan).ok());
    controller.set_protected(now, crops);
    if (i == 9000) controller.safety().set_emergency_stop(true);
    const ControllerOutput output = controller.update(now, Rig::kPeriod);
    for (const auto& event : output.events) {
      opened += event.kind == ControllerEventKind::kSprayOpened ? 1 : 0;
      skipped += event.kind == ControllerEventKind::kStopSkipped ? 1 : 0;
    }
    ASSERT_TRUE(valve.write(now, output.valve_open).ok());
    controller.safety().valve_written(now, output.valve_open, true);
    (void)valve.take_changes(now);
    ASSERT_TRUE(driver.write(now, Rig::kPeriod, output.axis).ok());
  }
  EXPECT_EQ(testing::allocations() - before, 0u);
  EXPECT_GT(opened, 10);
  EXPECT_GT(skipped, 0);
}

}  // namespace
}  // namespace furrow::actuation
