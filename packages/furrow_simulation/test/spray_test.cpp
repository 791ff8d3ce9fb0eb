#include "furrow_simulation/spray.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow::simulation {
namespace {

Time at(double s) {
  return Time::from_seconds(s);
}

TEST(FallTime, SolvesTheFall) {
  EXPECT_NEAR(fall_time_s(0.6, 0.0), std::sqrt(2.0 * 0.6 / 9.80665), 1e-12);  // dropped
  for (const double speed_mps : {0.0, 0.5, 12.0, 1e6}) {
    const double t = fall_time_s(0.6, speed_mps);
    EXPECT_NEAR(speed_mps * t + 9.80665 * t * t / 2, 0.6, 1e-12);
  }
  EXPECT_EQ(fall_time_s(0.0, 0.0), 0.0);
}

TEST(LandingPoint, DropsKeepTheNozzlesSpeedAndDrift) {
  SprayParameters parameters;
  parameters.drift_y_mps = 0.4;
  const NozzleState nozzle{.time = at(0.0), .p_F_m = {2.0, 0.3}, .v_F_mps = {0.5, -1.0}};
  const double fall_s = fall_time_s(0.6, parameters.droplet_speed_mps);
  Eigen::Vector2d p_F = landing_point(nozzle, 0.6, parameters);
  EXPECT_NEAR(p_F.x(), 2.0 + 0.5 * fall_s, 1e-12);
  EXPECT_NEAR(p_F.y(), 0.3 + (-1.0 + 0.4) * fall_s, 1e-12);
  parameters.carry = 0.0;
  p_F = landing_point(nozzle, 0.6, parameters);
  EXPECT_NEAR(p_F.x(), 2.0, 1e-12);
  EXPECT_NEAR(p_F.y(), 0.3 + 0.4 * fall_s, 1e-12);
}

TEST(SprayPatch, IsCentredBetweenFirstAndLastDrop) {
  SprayParameters parameters;
  parameters.droplet_speed_mps = 0.0;
  const NozzleState open{.time = at(1.0), .p_F_m = {2.0, 0.0}, .v_F_mps = {0.5, 0.0}};
  const NozzleState close{.time = at(1.04), .p_F_m = {2.02, 0.0}, .v_F_mps = {0.5, 0.0}};
  const double fall_s = std::sqrt(2.0 * 0.6 / 9.80665);
  const SprayPatch patch = spray_patch(open, close, 0.6, parameters);
  EXPECT_NEAR(patch.p_F_m.x(), 2.01 + 0.5 * fall_s, 1e-12);
  EXPECT_NEAR(patch.sweep_F_m.x(), 0.02, 1e-12);
  EXPECT_EQ(patch.sweep_F_m.y(), 0.0);
  EXPECT_NEAR(patch.time.to_seconds(), 1.02 + fall_s, 2e-9);
}

TEST(SimulatedValve, AnswersAfterItsDelays) {
  SprayParameters parameters;
  parameters.open_delay_s = 0.010;
  parameters.close_delay_s = 0.006;
  SimulatedValve valve(parameters, 1, 0);
  const auto window = valve.actuate(at(1.0), at(1.05));
  ASSERT_TRUE(window.has_value());
  EXPECT_EQ(window->open, at(1.010));
  EXPECT_EQ(window->close, at(1.056));
  // Closed before the first drop could leave.
  EXPECT_FALSE(valve.actuate(at(2.0), at(2.003)).has_value());
}

TEST(SimulatedValve, JitterScattersTheDelaysButNotBelowZero) {
  SprayParameters parameters;
  parameters.open_delay_s = 0.010;
  parameters.delay_jitter_s = 0.002;
  SimulatedValve valve(parameters, 1, 0);
  double sum_s = 0.0;
  double squares_s2 = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const auto window = valve.actuate(at(1.0), at(2.0));
    ASSERT_TRUE(window.has_value());
    const double late_s = (window->open - at(1.0)).to_seconds() - 0.010;
    sum_s += late_s;
    squares_s2 += late_s * late_s;
  }
  EXPECT_NEAR(sum_s / n, 0.0, 5 * 0.002 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares_s2 / n), 0.002, 0.0001);

  parameters.delay_jitter_s = 0.5;
  SimulatedValve wild(parameters, 1, 0);
  for (int i = 0; i < 200; ++i) {
    const auto window = wild.actuate(at(1.0), at(9.0));
    ASSERT_TRUE(window.has_value());
    EXPECT_GE(window->open, at(1.0));
    EXPECT_GE(*window->close, at(9.0));
  }
}

TEST(SimulatedValve, FaultsHaveTheirEffectAndDoNotDisturbTheSequence) {
  SprayParameters parameters;
  parameters.delay_jitter_s = 0.001;
  SimulatedValve healthy(parameters, 6, 2);
  SimulatedValve faulty(parameters, 6, 2);
  for (const ValveFault fault :
       {ValveFault::kStuckShut, ValveFault::kBlocked, ValveFault::kStuckOpen, ValveFault::kNone}) {
    faulty.set_fault(fault);
    const auto expected = healthy.actuate(at(1.0), at(1.1));
    const auto window = faulty.actuate(at(1.0), at(1.1));
    ASSERT_TRUE(expected.has_value());
    const bool drops = fault == ValveFault::kStuckOpen || fault == ValveFault::kNone;
    ASSERT_EQ(window.has_value(), drops);
    if (!drops) continue;
    EXPECT_EQ(window->open, expected->open);
    EXPECT_EQ(window->close.has_value(), fault == ValveFault::kNone);
  }
}

TEST(SimulatedValve, ValvesOfOneSeedDiffer) {
  SprayParameters parameters;
  parameters.delay_jitter_s = 0.001;
  SimulatedValve first(parameters, 6, 0);
  SimulatedValve second(parameters, 6, 1);
  EXPECT_NE(first.actuate(at(1.0), at(1.1))->open, second.actuate(at(1.0), at(1.1))->open);
}

}  // namespace
}  // namespace furrow::simulation
