// Each cause for the safe state in closed loop: detection, reaction, latch, reset.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "trip.hpp"

namespace furrow::actuation {
namespace {

using testing::paper_axis;
using testing::Rig;
using testing::stop_at;
using testing::Trip;

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
  parameters.safety.plan_deadline_s = 0.1;
  parameters.safety.odometry_deadline_s = 0.05;
  parameters.safety.tracks_deadline_s = 0.1;
  parameters.safety.loop_deadline_s = 0.03;
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
  EXPECT_EQ(trip.last(ControllerEventKind::kSafeState).cause, c.cause);
  EXPECT_EQ(trip.last(ControllerEventKind::kSprayClosed).reason, SkipReason::kFault);
  c.mend(trip);
  trip.opened_now = false;
  trip.run(0.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);  // mended, and yet latched
  EXPECT_FALSE(trip.opened_now);
  trip.reset();
  trip.run(0.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
  EXPECT_EQ(trip.count(ControllerEventKind::kReset), 1);
}

void mend_drive(Trip& trip) {
  trip.axis().driver.clear_faults();
}

INSTANTIATE_TEST_SUITE_P(
    All, Causes,
    ::testing::Values(
        CauseCase{"EmergencyStop", SafetyCause::kEmergencyStop, 0.002,
                  [](Trip& r) { r.safety().set_emergency_stop(true); },
                  [](Trip& r) { r.safety().set_emergency_stop(false); }},
        CauseCase{"EmergencyStopOfTheDrive", SafetyCause::kEmergencyStop, 0.002,
                  [](Trip& r) { ASSERT_TRUE(r.axis().driver.emergency_stop(r.rig.now()).ok()); },
                  mend_drive},
        CauseCase{"PeerLost", SafetyCause::kPeerLost, 0.074,
                  [](Trip& r) { r.rig.send_heartbeat = false; },
                  [](Trip& r) { r.rig.send_heartbeat = true; }},
        CauseCase{"TracksStale", SafetyCause::kTracksStale, 0.104,
                  [](Trip& r) { r.rig.send_tracks = false; },
                  [](Trip& r) { r.rig.send_tracks = true; }},
        CauseCase{"LoopStalled", SafetyCause::kLoopStalled, 0.002, [](Trip& r) { r.rig.stall(17); },
                  [](Trip&) {}},
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
                    r.axis().controller.set_odometry(r.rig.now(), bad);
                  },
                  [](Trip& r) { r.rig.send_odometry = true; }},
        CauseCase{"ReadingStale", SafetyCause::kReadingStale, 0.024,
                  [](Trip& r) { r.axis().driver.set_connected(r.rig.now(), false); },
                  [](Trip& r) {
                    r.axis().driver.set_connected(r.rig.now(), true);
                    mend_drive(r);
                  }},
        CauseCase{"DriveFault", SafetyCause::kDriveFault, 0.002,
                  [](Trip& r) { r.axis().driver.inject(r.rig.now(), DriveFault::kDrive); },
                  mend_drive},
        CauseCase{"PowerLost", SafetyCause::kDriveFault, 0.002,
                  [](Trip& r) { ASSERT_TRUE(r.axis().driver.disable(r.rig.now()).ok()); },
                  [](Trip&) {}},
        CauseCase{"FollowingError", SafetyCause::kFollowingError, 0.002,
                  [](Trip& r) { r.axis().driver.inject(r.rig.now(), DriveFault::kFollowingError); },
                  mend_drive},
        CauseCase{"ValveFault", SafetyCause::kValveFault, 0.004,
                  [](Trip& r) { r.axis().link.cut = true; },
                  [](Trip& r) { r.axis().link.cut = false; }},
        CauseCase{"ProtectionInvalid", SafetyCause::kProtectionInvalid, 0.010,
                  [](Trip& r) {
                    r.rig.crops = {{1, {std::nan(""), 0.0}}};
                  },
                  [](Trip& r) { r.rig.crops.clear(); }},
        CauseCase{"ProtectionOverflow", SafetyCause::kProtectionOverflow, 0.010,
                  [](Trip& r) { r.rig.crops.resize(kMaxProtectedPlants + 1); },
                  [](Trip& r) { r.rig.crops.clear(); }}),
    [](const auto& tested) { return tested.param.name; });

TEST(AxisController, MeasuredPositionAndFollowingErrorAreWatched) {
  const auto cause_of = [](double position_m, double following_error_m) {
    AxisController controller(paper_axis(0), {}, {});
    SafetyCause cause = SafetyCause::kNone;
    for (int i = 0; i < 50 && cause == SafetyCause::kNone; ++i) {
      const Time now = Time::from_seconds(1.0 + 0.002 * i);
      const bool bad = i > 10;
      controller.set_reading(now, {.stamp = now,
                                   .state = AxisState::kReady,
                                   .homed = true,
                                   .position_m = bad ? position_m : 0.0,
                                   .following_error_m = bad ? following_error_m : 0.0});
      controller.set_protected(now, {});
      controller.safety().heartbeat_came(now);
      controller.safety().valve_written(now, false, true);
      controller.set_odometry(now, {now, {}, {0.5, 0.0, 0.0}});
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

TEST(AxisController, ALostPeerStopsAMovingAxisWithinItsLimits) {
  Trip trip;
  trip.plan = {stop_at(1, {0.8, 0.69}, {})};
  trip.run(0.11);
  ASSERT_GT(trip.axis().driver.reading().velocity_mps, 1.0);
  trip.rig.send_heartbeat = false;
  while (trip.axis().output.mode == ControllerMode::kRunning) trip.run(0.002);
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

TEST(AxisSafety, AnEmergencyStopMakesTheDriveStopAndRemovesItsPower) {
  Trip trip;
  trip.plan = {stop_at(1, {0.8, 0.69}, {})};
  trip.run(0.11);
  ASSERT_GT(trip.axis().driver.reading().velocity_mps, 1.0);
  trip.safety().set_emergency_stop(true);
  trip.run(0.002);
  EXPECT_EQ(trip.axis().driver.reading().state, AxisState::kEmergencyStop);
  EXPECT_TRUE(trip.axis().driver.reading().powered);  // it brakes
  trip.run(0.3);
  EXPECT_EQ(trip.axis().driver.reading().velocity_mps, 0.0);
  EXPECT_FALSE(trip.axis().driver.reading().powered);
  EXPECT_TRUE(trip.axis().loop.supervisor().power_off_confirmed());
}

TEST(AxisSafety, AResetWhileTheCauseHoldsIsRefusedAndNothingMoves) {
  Trip trip;
  trip.run(0.1);
  trip.safety().set_emergency_stop(true);
  trip.run(0.3);
  trip.reset();
  trip.run(0.3);
  EXPECT_EQ(trip.count(ControllerEventKind::kResetRefused), 1);
  EXPECT_EQ(trip.count(ControllerEventKind::kReset), 0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
  EXPECT_FALSE(trip.axis().driver.reading().powered);
}

TEST(AxisSafety, AResetOfALostPeerClearsNoOtherCause) {
  Trip trip;
  trip.run(0.1);
  trip.axis().driver.inject(trip.rig.now(), DriveFault::kDrive);
  trip.rig.send_heartbeat = false;
  trip.axis().link.cut = true;
  trip.run(0.2);
  trip.axis().driver.clear_faults();
  trip.axis().link.cut = false;
  trip.rig.send_heartbeat = true;
  trip.run(0.2);
  ASSERT_TRUE(trip.safety().latched().contains(SafetyCause::kDriveFault));
  ASSERT_TRUE(trip.safety().latched().contains(SafetyCause::kValveFault));
  trip.reset(SafetyCause::kPeerLost);
  trip.run(0.5);
  EXPECT_TRUE(trip.safety().latched().contains(SafetyCause::kDriveFault));
  EXPECT_TRUE(trip.safety().latched().contains(SafetyCause::kValveFault));
  EXPECT_FALSE(trip.axis().driver.reading().powered);
  trip.reset(SafetyCause::kDriveFault);  // the drive stays off while the valve's fault is latched
  trip.run(0.5);
  EXPECT_EQ(trip.last(ControllerEventKind::kResetRefused).cause, SafetyCause::kDriveFault);
  EXPECT_FALSE(trip.axis().driver.reading().powered);
  trip.reset(SafetyCause::kValveFault);
  trip.run(0.1);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
  trip.reset(SafetyCause::kDriveFault);
  trip.run(0.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
}

TEST(AxisSafety, ADriveThatFaultsWhileItHoldsIsLatchedToo) {
  Trip trip;
  trip.run(0.1);
  trip.rig.send_heartbeat = false;
  trip.run(0.2);
  ASSERT_EQ(trip.axis().output.cause, SafetyCause::kPeerLost);
  trip.axis().driver.inject(trip.rig.now(), DriveFault::kDrive);
  trip.axis().driver.clear_faults();
  trip.rig.send_heartbeat = true;
  trip.run(0.2);
  trip.reset(SafetyCause::kPeerLost);
  trip.run(0.5);
  EXPECT_TRUE(trip.safety().latched().contains(SafetyCause::kDriveFault));
  EXPECT_FALSE(trip.axis().driver.reading().powered);
}

TEST(AxisSafety, ADriveWhoseCauseHoldsRefusesItsReset) {
  Trip trip;
  trip.run(0.1);
  trip.axis().driver.inject(trip.rig.now(), DriveFault::kDrive);
  trip.run(0.2);
  trip.reset();
  trip.run(DriveSupervisor::kPatience.to_seconds() + 0.5);
  EXPECT_EQ(trip.count(ControllerEventKind::kResetRefused), 1);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
  trip.axis().driver.clear_faults();
  trip.run(1.0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
}

TEST(AxisSafety, RestoredLatchesKeepTheDriveOffUntilTheirReset) {
  Trip trip;
  CauseSet left;
  left.insert(SafetyCause::kValveFault);
  left.insert(SafetyCause::kPeerLost);
  trip.safety().restore(left, trip.rig.now());
  trip.plan = {stop_at(1, {0.5, 0.1}, {})};
  trip.run(0.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
  EXPECT_FALSE(trip.axis().driver.reading().powered);
  trip.reset(SafetyCause::kPeerLost);
  trip.run(0.3);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kSafe);
  trip.reset(SafetyCause::kValveFault);
  trip.run(0.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
}

TEST(AxisSafety, ARaisedToolHoldsSpraysNothingAndResumesByItself) {
  Trip trip;
  trip.plan = {stop_at(1, {0.5, 0.2}, {}), stop_at(2, {1.2, 0.2}, {})};
  trip.run(0.2);
  trip.safety().set_active(false);
  trip.rig.send_heartbeat = false;  // a raised tool needs no planner
  trip.run(1.0);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kInactive);
  EXPECT_EQ(trip.last(ControllerEventKind::kStopSkipped).reason, SkipReason::kInactive);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 0);
  EXPECT_TRUE(trip.axis().driver.reading().powered);
  trip.rig.send_heartbeat = true;
  trip.safety().set_active(true);
  trip.run(1.5);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
  EXPECT_EQ(trip.count(ControllerEventKind::kSafeState), 0);
}

TEST(AxisSafety, OneUnconfirmedRefreshOfAShutValveIsNoFault) {
  Trip trip;
  trip.run(0.1);
  trip.axis().link.cut = true;
  trip.run(0.012);
  trip.axis().link.cut = false;
  trip.run(0.1);
  EXPECT_EQ(trip.axis().output.mode, ControllerMode::kRunning);
}

TEST(AxisSafety, AtTheEndOfTheProcessValveAndDriveAreSafe) {
  Trip trip;
  trip.plan = {stop_at(1, {0.8, 0.69}, {})};
  trip.run(0.11);
  ASSERT_GT(trip.axis().driver.reading().velocity_mps, 1.0);
  EXPECT_TRUE(trip.axis().loop.shut_down(trip.rig.now(), 5.0).complete());
  EXPECT_EQ(trip.axis().driver.reading().velocity_mps, 0.0);
  EXPECT_FALSE(trip.axis().driver.reading().powered);
}

TEST(AxisSafety, WhatIsNotConfirmedAtTheEndIsTold) {
  Trip trip;
  trip.run(0.1);
  trip.axis().link.cut = true;
  trip.axis().driver.set_connected(trip.rig.now(), false);
  const StopConfirmation confirmed = trip.axis().loop.shut_down(trip.rig.now(), 0.01);
  EXPECT_FALSE(confirmed.valve_shut);
  EXPECT_FALSE(confirmed.power_off);
}

TEST(AxisSafety, ALongStopKeepsTargetsFreshAndDrivingOnSpraysThem) {
  AxisControllerParameters parameters;
  parameters.max_target_age_s = 3.0;
  const auto speed = [](double t) { return Twist2{t > 0.5 && t < 60.5 ? 0.0 : 0.5, 0.0, 0.0}; };
  Trip trip(parameters, speed);
  trip.fresh = false;  // seen once, at the start
  trip.plan = {stop_at(1, {0.9, 0.2}, {})};
  trip.run(60.0);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 0);
  trip.run(3.0);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
  EXPECT_EQ(trip.count(ControllerEventKind::kSafeState), 0);
}

TEST(AxisSafety, ReversingOverPassedGroundSpraysNothingThere) {
  // Ahead to 1 m, back to 0.4 m, ahead again.
  const auto speed = [](double t) {
    return Twist2{t < 2.0 ? 0.5 : t < 4.0 ? -0.3 : 0.5, 0.0, 0.0};
  };
  Trip trip({}, speed);
  trip.plan = {stop_at(1, {0.9, 0.2}, {})};
  trip.run(2.5);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 1);
  trip.plan = {stop_at(7, {0.9, 0.2}, {}), stop_at(8, {1.4, 0.2}, {})};  // the weed's second track
  trip.run(4.5);
  EXPECT_EQ(trip.count(ControllerEventKind::kSprayOpened), 2);
  EXPECT_EQ(trip.last(ControllerEventKind::kSprayOpened).stop_id, 8);
}

}  // namespace
}  // namespace furrow::actuation
