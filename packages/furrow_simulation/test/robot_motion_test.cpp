#include "furrow_simulation/robot_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "furrow_core/error.hpp"

namespace furrow::simulation {
namespace {

Time at(double s) {
  return Time::from_seconds(s);
}

TEST(RobotMotion, WithoutNoiseItDrivesStraightAtItsSpeed) {
  RobotMotionParameters parameters;
  parameters.start_x_m = -1.0;
  RobotMotion motion(parameters, 1, at(100.0));
  for (const double t : {0.0, 0.00037, 0.2, 1.0, 60.0}) {
    const RobotState& state = motion.advance_to(at(100.0 + t));
    EXPECT_NEAR(state.X_FB.x_m, -1.0 + 0.5 * t, 1e-9);
    EXPECT_EQ(state.X_FB.y_m, 0.0);
    EXPECT_EQ(state.X_FB.heading_rad, 0.0);
    EXPECT_DOUBLE_EQ(state.speed_mps, 0.5);
    EXPECT_EQ(state.time, at(100.0 + t));
  }
}

TEST(RobotMotion, FollowsASpeedProfile) {
  RobotMotionParameters parameters;
  // Held, ramp from 0.2 to 1.0 m/s in 4 s, a step to 0.4, to a stop in 2 s, held.
  parameters.profile_time_s = {1.0, 5.0, 5.0, 6.0, 8.0};
  parameters.profile_speed_mps = {0.2, 1.0, 0.4, 0.4, 0.0};
  RobotMotion motion(parameters, 1);
  EXPECT_NEAR(motion.advance_to(at(1.0)).X_FB.x_m, 0.2, 1e-9);
  EXPECT_NEAR(motion.advance_to(at(3.0)).speed_mps, 0.6, 1e-9);
  EXPECT_NEAR(motion.state().X_FB.x_m, 0.2 + 0.4 * 2.0, 1e-9);  // mean of 0.2 and 0.6
  EXPECT_NEAR(motion.state().acceleration_mps2, 0.2, 1e-6);
  EXPECT_NEAR(motion.advance_to(at(5.001)).speed_mps, 0.4, 1e-9);
  // The step is spread over one millisecond: 0.6 m/s of it, halved.
  EXPECT_NEAR(motion.advance_to(at(6.0)).X_FB.x_m, 0.2 + 2.4 + 0.4, 0.0004);
  const double stopped_x_m = motion.advance_to(at(8.0)).X_FB.x_m;
  EXPECT_NEAR(stopped_x_m, 3.0 + 0.4, 0.0004);
  EXPECT_NEAR(motion.advance_to(at(20.0)).X_FB.x_m, stopped_x_m, 1e-12);
}

RobotMotionParameters noisy() {
  RobotMotionParameters parameters;
  parameters.speed_noise_mps = 0.02;
  parameters.yaw_noise_radps = 0.02;
  return parameters;
}

TEST(RobotMotion, PathDoesNotDependOnTheCallersSteps) {
  RobotMotion coarse(noisy(), 7);
  RobotMotion fine(noisy(), 7);
  RobotMotion odd(noisy(), 7);
  coarse.advance_to(at(2.0));
  for (int i = 0; i < 2000; ++i) fine.step(Duration::milliseconds(1));
  while (odd.state().time < at(2.0)) {
    odd.advance_to(std::min(odd.state().time + Duration::nanoseconds(777'777), at(2.0)));
  }
  for (const RobotMotion* motion : {&fine, &odd}) {
    EXPECT_EQ(motion->state().X_FB.x_m, coarse.state().X_FB.x_m);
    EXPECT_EQ(motion->state().X_FB.y_m, coarse.state().X_FB.y_m);
    EXPECT_EQ(motion->state().X_FB.heading_rad, coarse.state().X_FB.heading_rad);
  }
  RobotMotion other(noisy(), 8);
  EXPECT_NE(other.advance_to(at(2.0)).X_FB.y_m, coarse.state().X_FB.y_m);
}

TEST(RobotMotion, ApproachesALimitAndItsOwnSpeedGradually) {
  RobotMotionParameters parameters;
  parameters.limit_acceleration_mps2 = 0.4;
  RobotMotion motion(parameters, 1);
  motion.advance_to(at(1.0));
  motion.limit_speed(0.3);
  EXPECT_NEAR(motion.advance_to(at(1.25)).speed_mps, 0.5 - 0.4 * 0.25, 1e-3);
  EXPECT_NEAR(motion.advance_to(at(2.0)).speed_mps, 0.3, 1e-12);
  // 0.5 s at a mean of 0.4, then held; a cell of 1 ms may have begun before the limit came.
  EXPECT_NEAR(motion.state().X_FB.x_m, 0.5 + 0.2 + 0.15, 5e-4);
  motion.limit_speed(std::nullopt);
  EXPECT_NEAR(motion.advance_to(at(2.25)).speed_mps, 0.4, 1e-3);
  EXPECT_DOUBLE_EQ(motion.advance_to(at(3.0)).speed_mps, 0.5);
}

TEST(RobotMotion, ALimitAboveItsOwnSpeedChangesNothing) {
  RobotMotion free(noisy(), 3);
  RobotMotion limited(noisy(), 3);
  limited.limit_speed(2.0);
  EXPECT_EQ(limited.advance_to(at(5.0)).X_FB.x_m, free.advance_to(at(5.0)).X_FB.x_m);
  limited.limit_speed(std::nullopt);
  EXPECT_EQ(limited.advance_to(at(9.0)).X_FB.y_m, free.advance_to(at(9.0)).X_FB.y_m);
}

TEST(RobotMotion, ALimitHoldsInBothDirectionsAndDownToAStandstill) {
  RobotMotionParameters parameters;
  parameters.profile_time_s = {0.0, 4.0};
  parameters.profile_speed_mps = {-0.4, 0.4};
  RobotMotion motion(parameters, 1);
  motion.limit_speed(0.1);
  for (const double t : {2.0, 2.2, 3.0, 4.0, 5.0}) {
    EXPECT_LE(std::abs(motion.advance_to(at(t)).speed_mps), 0.1 + 1e-12) << t;
  }
  motion.limit_speed(0.0);
  EXPECT_NEAR(motion.advance_to(at(6.0)).speed_mps, 0.0, 1e-12);
}

TEST(RobotMotion, IgnoresEarlierTimes) {
  RobotMotion motion(noisy(), 7);
  const double x_m = motion.advance_to(at(1.0)).X_FB.x_m;
  EXPECT_EQ(motion.advance_to(at(0.5)).X_FB.x_m, x_m);
  EXPECT_EQ(motion.state().time, at(1.0));
}

TEST(RobotMotion, StateIsConsistentWithItsDerivatives) {
  RobotMotion motion(noisy(), 3);
  RobotState before = motion.state();
  for (int i = 0; i < 500; ++i) {
    const RobotState after = motion.step(Duration::milliseconds(1));
    const double dx = after.X_FB.x_m - before.X_FB.x_m;
    const double dy = after.X_FB.y_m - before.X_FB.y_m;
    EXPECT_NEAR(std::hypot(dx, dy), (before.speed_mps + after.speed_mps) / 2 * 1e-3, 1e-10);
    EXPECT_NEAR(after.X_FB.heading_rad - before.X_FB.heading_rad, before.yaw_rate_radps * 1e-3,
                1e-12);
    before = after;
  }
}

TEST(RobotMotion, SpeedNoiseHasItsDeviationAndCorrelation) {
  RobotMotionParameters parameters;
  parameters.speed_noise_mps = 0.05;
  parameters.speed_correlation_s = 0.2;
  RobotMotion motion(parameters, 11);
  double sum = 0.0;
  double squares = 0.0;
  double lagged = 0.0;
  double last = 0.0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    // At one correlation time from reading to reading, successive ones correlate by 1/e.
    const double v = motion.step(Duration::milliseconds(200)).speed_mps - 0.5;
    sum += v;
    squares += v * v;
    lagged += v * last;
    last = v;
  }
  EXPECT_NEAR(sum / n, 0.0, 5 * 0.05 / std::sqrt(n / 2.0));
  EXPECT_NEAR(std::sqrt(squares / n), 0.05, 0.004);
  EXPECT_NEAR(lagged / squares, std::exp(-1.0), 0.08);
}

TEST(RobotMotion, SteeringIsCriticallyDampedInBothDirections) {
  for (const double speed_mps : {0.5, -0.5}) {
    RobotMotionParameters parameters;
    parameters.speed_mps = speed_mps;
    parameters.start_y_m = 0.05;
    RobotMotion motion(parameters, 1);
    for (const double s_m : {0.5, 1.0, 2.0, 5.0}) {
      // Of y'' = -y / L^2 - 2 y' / L with y(0) = y0, y'(0) = 0, L = 1 m.
      const double expected_m = 0.05 * (1.0 + s_m) * std::exp(-s_m);
      EXPECT_NEAR(motion.advance_to(at(s_m / 0.5)).X_FB.y_m, expected_m, 5e-4);
    }
    EXPECT_NEAR(motion.state().X_FB.x_m, speed_mps * 10.0, 0.01);
  }
}

TEST(RobotMotion, SteeringKeepsADisturbedRobotNearTheLine) {
  RobotMotionParameters parameters = noisy();
  parameters.start_y_m = 8.0;  // far beyond the steering distance
  RobotMotion motion(parameters, 5);
  motion.advance_to(at(80.0));
  double worst_m = 0.0;
  for (int i = 0; i < 1000; ++i) {
    worst_m = std::max(worst_m, std::abs(motion.step(Duration::milliseconds(100)).X_FB.y_m));
  }
  EXPECT_LT(worst_m, 0.2);
  EXPECT_GT(worst_m, 0.001);
}

TEST(RobotMotion, SlippingWheelsTurnFasterThanTheGroundPasses) {
  RobotMotionParameters parameters;
  parameters.slip = 0.1;
  RobotMotion motion(parameters, 1);
  const RobotState& state = motion.advance_to(at(10.0));
  EXPECT_NEAR(state.X_FB.x_m, 0.9 * 5.0, 1e-9);
  EXPECT_DOUBLE_EQ(state.wheel_speed_mps, 0.5);
  EXPECT_DOUBLE_EQ(state.speed_mps, 0.45);
}

TEST(RobotMotion, RefusesBadParameters) {
  const auto refuses = [](auto change) {
    RobotMotionParameters parameters;
    change(parameters);
    EXPECT_THROW(RobotMotion(parameters, 1), ConfigError);
  };
  refuses([](auto& p) { p.profile_time_s = {0.0, 1.0}; });
  refuses([](auto& p) {
    p.profile_time_s = {1.0, 0.0};
    p.profile_speed_mps = {0.0, 0.0};
  });
  refuses([](auto& p) { p.slip = 1.0; });
  refuses([](auto& p) { p.speed_correlation_s = 0.0; });
  refuses([](auto& p) { p.speed_mps = std::numeric_limits<double>::quiet_NaN(); });
}

}  // namespace
}  // namespace furrow::simulation
