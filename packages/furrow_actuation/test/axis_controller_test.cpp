#include "furrow_actuation/axis_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "allocation_counter.hpp"
#include "furrow_core/error.hpp"
#include "rig.hpp"

namespace furrow::actuation {
namespace {

using testing::paper_axis;
using testing::Rig;
using testing::stop_at;

Twist2 steady(double) {
  return {0.5, 0.0, 0.0};
}

SimulatedAxisParameters ready() {
  SimulatedAxisParameters parameters;
  parameters.start_ready = true;
  return parameters;
}

/// One axis at 0.5 m/s on a plan that is sent again at 50 Hz.
class Trip {
 public:
  explicit Trip(const AxisControllerParameters& parameters = {}, Rig::Speed speed = steady,
                const SimulatedAxisParameters& drive = ready())
      : rig(1, parameters, {}, {}, drive, std::move(speed)) {}

  void run(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.002) {
      if (send_plan) send();
      rig.step();
      opened_now = opened_now || axis().output.valve_open;
    }
  }
  void send() {
    auto stops = plan;
    for (auto& stop : stops) {
      if (fresh) stop.observed = rig.now();
    }
    ASSERT_TRUE(axis().controller.set_plan(rig.now(), stops).ok());
  }
  Rig::Axis& axis() { return rig.axis(0); }
  [[nodiscard]] int count(ControllerEventKind kind) {
    int n = 0;
    for (const auto& event : axis().events) n += event.kind == kind ? 1 : 0;
    return n;
  }
  [[nodiscard]] ControllerEvent last(ControllerEventKind kind) {
    ControllerEvent found;
    for (const auto& event : axis().events) {
      if (event.kind == kind) found = event;
    }
    return found;
  }

  Rig rig;
  std::vector<PlannedStop> plan;
  bool send_plan = true;
  bool fresh = true;
  bool opened_now = false;
};

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
    trip.axis().controller.reset();  // of what has become too old meanwhile
    trip.run(2.0);
    EXPECT_EQ(trip.axis().driver.reading().fault, DriveFault::kNone) << cycles;
    EXPECT_NE(trip.last(ControllerEventKind::kMadeSafe).cause, SafetyCause::kFollowingError);
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
    const std::vector<ProtectedPlant> crops{{7, {0.62, 0.21}}};
    trip.axis().controller.set_protected(crops);
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
  const std::vector<ProtectedPlant> crops{{7, {0.6, 0.21}}};
  trip.axis().controller.set_protected(crops);
  trip.run(0.002);
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

struct CauseCase {
  const char* name;
  SafetyCause cause;
  double within_s;
  std::function<void(Trip&)> inject;
  std::function<void(Trip&)> mend;
};

class Causes : public ::testing::TestWithParam<CauseCase> {};

TEST_P(Causes, ShutsTheValveStopsTheAxisAndLatches) {
  const CauseCase& c = GetParam();
  AxisControllerParameters parameters;
  parameters.dwell_s = 0.5;  // the cause strikes while the valve is open
  parameters.plan_deadline_s = 0.1;
  parameters.odometry_deadline_s = 0.05;
  Trip trip(parameters, [](double) { return Twist2{0.1, 0.0, 0.0}; });
  trip.plan = {stop_at(1, {0.35, 0.3}, {}), stop_at(2, {0.45, -0.6}, {})};
  for (int i = 0; i < 5000 && !trip.axis().output.valve_open; ++i) trip.run(0.002);
  ASSERT_TRUE(trip.axis().output.valve_open);
  c.inject(trip);
  const Time struck = trip.rig.now();
  for (int i = 0; i < 1000 && trip.axis().output.mode != ControllerMode::kSafe; ++i)
    trip.run(0.002);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
  EXPECT_EQ(trip.axis().output.cause, c.cause);
  EXPECT_FALSE(trip.axis().output.valve_open);
  EXPECT_LE((trip.axis().output.cause_time - struck).to_seconds(), c.within_s + 1e-9);
  EXPECT_EQ(trip.last(ControllerEventKind::kMadeSafe).cause, c.cause);
  EXPECT_EQ(trip.last(ControllerEventKind::kSprayClosed).reason, SkipReason::kFault);
  c.mend(trip);
  trip.opened_now = false;
  trip.run(0.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);  // mended, and yet latched
  EXPECT_FALSE(trip.opened_now);
  trip.axis().controller.reset();
  trip.run(0.1);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
  EXPECT_EQ(trip.count(ControllerEventKind::kReset), 1);
}

void restart_drive(Trip& trip) {
  auto& driver = trip.axis().driver;
  driver.clear_faults();
  ASSERT_TRUE(driver.reset(trip.rig.now()).ok());
  ASSERT_TRUE(driver.enable(trip.rig.now()).ok());
}

INSTANTIATE_TEST_SUITE_P(
    All, Causes,
    ::testing::Values(
        CauseCase{"EmergencyStop", SafetyCause::kEmergencyStop, 0.002,
                  [](Trip& r) { r.axis().controller.set_emergency_stop(true); },
                  [](Trip& r) { r.axis().controller.set_emergency_stop(false); }},
        CauseCase{"EmergencyStopOfTheDrive", SafetyCause::kEmergencyStop, 0.002,
                  [](Trip& r) { ASSERT_TRUE(r.axis().driver.emergency_stop(r.rig.now()).ok()); },
                  restart_drive},
        CauseCase{"PeerLost", SafetyCause::kPeerLost, 0.002,
                  [](Trip& r) { r.axis().controller.set_peer_lost(true); },
                  [](Trip& r) { r.axis().controller.set_peer_lost(false); }},
        CauseCase{"PlanStale", SafetyCause::kPlanStale, 0.104, [](Trip& r) { r.send_plan = false; },
                  [](Trip& r) { r.send_plan = true; }},
        CauseCase{"OdometryStale", SafetyCause::kOdometryStale, 0.054,
                  [](Trip& r) { r.rig.send_odometry = false; },
                  [](Trip& r) { r.rig.send_odometry = true; }},
        CauseCase{"OdometryInvalid", SafetyCause::kOdometryInvalid, 0.002,
                  [](Trip& r) {
                    BaseState bad = r.rig.base();
                    bad.X_FB.y_m = std::numeric_limits<double>::quiet_NaN();
                    r.rig.send_odometry = false;
                    r.axis().controller.set_odometry(bad);
                  },
                  [](Trip& r) { r.rig.send_odometry = true; }},
        CauseCase{"ReadingStale", SafetyCause::kReadingStale, 0.024,
                  [](Trip& r) { r.axis().driver.set_connected(r.rig.now(), false); },
                  [](Trip& r) {
                    r.axis().driver.set_connected(r.rig.now(), true);
                    restart_drive(r);
                  }},
        CauseCase{"DriveFault", SafetyCause::kDriveFault, 0.002,
                  [](Trip& r) { r.axis().driver.inject(r.rig.now(), DriveFault::kDrive); },
                  restart_drive},
        CauseCase{"PowerLost", SafetyCause::kDriveFault, 0.002,
                  [](Trip& r) { ASSERT_TRUE(r.axis().driver.disable(r.rig.now()).ok()); },
                  [](Trip& r) { ASSERT_TRUE(r.axis().driver.enable(r.rig.now()).ok()); }},
        CauseCase{"FollowingError", SafetyCause::kFollowingError, 0.002,
                  [](Trip& r) { r.axis().driver.inject(r.rig.now(), DriveFault::kFollowingError); },
                  restart_drive},
        CauseCase{"ValveFault", SafetyCause::kValveFault, 0.002,
                  [](Trip& r) { r.axis().controller.set_valve_fault(true); },
                  [](Trip& r) { r.axis().controller.set_valve_fault(false); }},
        CauseCase{"ProtectionOverflow", SafetyCause::kProtectionOverflow, 0.002,
                  [](Trip& r) {
                    const std::vector<ProtectedPlant> many(kMaxProtectedPlants + 1);
                    r.axis().controller.set_protected(many);
                  },
                  [](Trip& r) { r.axis().controller.set_protected({}); }}),
    [](const auto& tested) { return tested.param.name; });

TEST(AxisController, MeasuredPositionAndFollowingErrorAreWatched) {
  const auto cause_of = [](double position_m, double following_error_m) {
    AxisController controller(paper_axis(0), {}, {});
    SafetyCause cause = SafetyCause::kNone;
    for (int i = 0; i < 50 && cause == SafetyCause::kNone; ++i) {
      const Time now = Time::from_seconds(1.0 + 0.002 * i);
      const bool bad = i > 10;
      controller.set_reading({now, AxisState::kReady, DriveFault::kNone, true,
                              bad ? position_m : 0.0, 0.0, bad ? following_error_m : 0.0});
      controller.set_odometry({now, {}, {0.5, 0.0, 0.0}});
      EXPECT_TRUE(controller.set_plan(now, {}).ok());
      cause = controller.update(now, Rig::kPeriod).cause;
    }
    return cause;
  };
  EXPECT_EQ(cause_of(0.1, 0.01), SafetyCause::kNone);
  EXPECT_EQ(cause_of(0.70, 0.0), SafetyCause::kPositionLimit);
  EXPECT_EQ(cause_of(std::nan(""), 0.0), SafetyCause::kPositionLimit);
  EXPECT_EQ(cause_of(0.1, 0.04), SafetyCause::kFollowingError);
  EXPECT_EQ(cause_of(0.1, std::nan("")), SafetyCause::kFollowingError);
}

TEST(AxisController, ACauseStopsAMovingAxisWithinItsLimits) {
  Trip trip;
  trip.plan = {stop_at(1, {0.8, 0.69}, {})};
  trip.run(0.11);
  ASSERT_GT(trip.axis().driver.reading().velocity_mps, 1.0);
  trip.axis().controller.set_emergency_stop(true);
  MotionState last = trip.axis().controller.setpoint();
  for (int i = 0; i < 200; ++i) {
    trip.run(0.002);
    const MotionState s = trip.axis().controller.setpoint();
    ASSERT_LE(std::abs(s.velocity_mps - last.velocity_mps), 50.0 * 0.002 + 1e-6);
    ASSERT_LE(std::abs(s.acceleration_mps2 - last.acceleration_mps2), 2000.0 * 0.002 + 1e-6);
    last = s;
  }
  EXPECT_EQ(last.velocity_mps, 0.0);
  EXPECT_LT(last.position_m, 0.695);
  EXPECT_NEAR(trip.axis().driver.reading().position_m, last.position_m, 1e-6);
}

TEST(AxisController, WaitsUntilEverythingIsThere) {
  SimulatedAxisParameters drive;
  Trip trip({}, steady, drive);
  trip.plan = {stop_at(1, {0.5, 0.2}, {}), stop_at(2, {2.0, 0.2}, {})};
  trip.run(1.0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kWaiting);
  EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kFault);
  EXPECT_EQ(trip.count(ControllerEventKind::kStopSkipped), 1);
  ASSERT_TRUE(trip.axis().driver.enable(trip.rig.now()).ok());
  ASSERT_TRUE(trip.axis().driver.home(trip.rig.now()).ok());
  trip.run(3.0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
  EXPECT_EQ(trip.count(ControllerEventKind::kMadeSafe), 0);
}

TEST(AxisController, RefusesBadPlansAndConfiguration) {
  AxisController controller(paper_axis(0), {}, {});
  std::vector<PlannedStop> many(kMaxPlanStops + 1, stop_at(1, {1.0, 0.0}, {}));
  EXPECT_EQ(controller.set_plan({}, many).error().code, ErrorCode::kOutOfRange);
  const std::vector<PlannedStop> bad{stop_at(1, {std::nan(""), 0.0}, {})};
  EXPECT_EQ(controller.set_plan({}, bad).error().code, ErrorCode::kInvalidArgument);
  const std::vector<PlannedStop> nobody(1);
  EXPECT_EQ(controller.set_plan({}, nobody).error().code, ErrorCode::kInvalidArgument);
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
    controller.set_reading(driver.reading());
    controller.set_odometry({now, {x, 0.0, 0.0}, {standing ? 0.0 : 0.5, 0.0, 0.02}});
    for (auto& stop : plan) stop.observed = now;
    ASSERT_TRUE(controller.set_plan(now, plan).ok());
    controller.set_protected(crops);
    if (i == 9000) controller.set_emergency_stop(true);
    const ControllerOutput output = controller.update(now, Rig::kPeriod);
    for (const auto& event : output.events) {
      opened += event.kind == ControllerEventKind::kSprayOpened ? 1 : 0;
      skipped += event.kind == ControllerEventKind::kStopSkipped ? 1 : 0;
    }
    ASSERT_TRUE(valve.write(now, output.valve_open).ok());
    (void)valve.take_changes(now);
    ASSERT_TRUE(driver.write(now, Rig::kPeriod, output.axis).ok());
  }
  EXPECT_EQ(testing::allocations() - before, 0u);
  EXPECT_GT(opened, 10);
  EXPECT_GT(skipped, 0);
}

}  // namespace
}  // namespace furrow::actuation
