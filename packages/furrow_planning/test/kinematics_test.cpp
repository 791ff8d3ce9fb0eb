#include "furrow_planning/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "furrow_core/random.hpp"

namespace furrow::planning {
namespace {

TEST(Feasibility, CutoffIsWhereGammaEqualsRho) {
  for (const double rho : {0.5, 0.6, 0.9, 0.99}) {
    for (const double omega : {1.0, 20.0, 300.0}) {
      const double s = cutoff_s(rho, omega);
      EXPECT_NEAR(feasibility(s, omega), rho, 1e-12);
      EXPECT_LT(feasibility(s - 1e-3 / omega, omega), rho);
    }
  }
  // The figures of the paper: Gamma >= 0.6 at omega = 20 asks for 20 ms.
  EXPECT_NEAR(cutoff_s(0.6, 20.0), 0.0203, 1e-4);
}

TEST(Feasibility, BoundaryScoreIsOneHalf) {
  // 0.1 m ahead at 0.5 m/s takes 0.2 s, as does 1 m aside at 5 m/s.
  EXPECT_DOUBLE_EQ(favorability_s(0.1, 1.0, 0.5, 5.0), 0.0);
  EXPECT_DOUBLE_EQ(favorability_s(0.1, -1.0, 0.5, 5.0), 0.0);
  EXPECT_DOUBLE_EQ(feasibility(0.0, 20.0), 0.5);
}

TEST(Feasibility, ReachIsTheSignOfTheFavorability) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double dx = random.uniform(-0.1, 0.3);
    const double dy = random.uniform(-1.4, 1.4);
    EXPECT_EQ(can_reach(dx, dy, 0.5, 5.0), favorability_s(dx, dy, 0.5, 5.0) > 0.0 && dx > 0.0);
  }
}

TEST(MoveTime, TrapezoidMatchesIntegrationOfItsProfile) {
  const double v = 1.0;
  const double a = 8.0;
  for (const double distance : {0.0, 0.01, 0.1, 0.125, 0.2, 1.0}) {
    // Bang-bang with a velocity limit, stepped finely: accelerate as long as one can still brake.
    double position = 0.0;
    double velocity = 0.0;
    double time = 0.0;
    const double dt = 1e-6;
    while (distance - position > 1e-6 && time < 10.0) {
      const bool brake = velocity * velocity / (2.0 * a) >= distance - position;
      velocity = brake ? std::max(velocity - a * dt, 1e-4) : std::min(v, velocity + a * dt);
      position += velocity * dt;
      time += dt;
    }
    EXPECT_NEAR(move_time_s(Kinematics::kTrapezoid, distance, v, a), time, 2e-2) << distance;
  }
}

TEST(MoveTime, TrapezoidIsNeverFasterAndTendsToVelocity) {
  for (const double d : {0.001, 0.05, 0.7, 1.39}) {
    const double plain = move_time_s(Kinematics::kVelocity, d, 5.0, 50.0);
    EXPECT_GT(move_time_s(Kinematics::kTrapezoid, d, 5.0, 50.0), plain);
    EXPECT_NEAR(move_time_s(Kinematics::kTrapezoid, d, 5.0, 1e9), plain, 1e-3);
    EXPECT_DOUBLE_EQ(move_time_s(Kinematics::kTrapezoid, -d, 5.0, 50.0),
                     move_time_s(Kinematics::kTrapezoid, d, 5.0, 50.0));
  }
}

TEST(Transition, IsAPartialOrderUnderBothKinematics) {
  Random random(2);
  for (const char* kinematics : {"velocity", "trapezoid"}) {
    PlannerParameters parameters;
    parameters.kinematics = kinematics;
    parameters.dwell_s = 0.004;
    const Transition transition(parameters, 0.5, AxisSpec{});
    int chained = 0;
    for (int i = 0; i < 200000; ++i) {
      const double x1 = random.uniform(0.0, 0.1);
      const double x2 = x1 + random.uniform(0.0, 0.1);
      const double y1 = random.uniform(-0.695, 0.695);
      const double y2 = random.uniform(-0.695, 0.695);
      if (transition.feasible(x1, y1) && transition.feasible(x2 - x1, y2 - y1)) {
        ++chained;
        EXPECT_TRUE(transition.feasible(x2 + 1e-9, y2));
      }
      EXPECT_FALSE(transition.feasible(x1, y1) && transition.feasible(-x1, -y1));
    }
    EXPECT_GT(chained, 100);
  }
}

TEST(Transition, MarginAddsDwellAndSettle) {
  PlannerParameters parameters;
  parameters.dwell_s = 0.05;
  parameters.settle_s = 0.01;
  const Transition transition(parameters, 0.5, AxisSpec{});
  EXPECT_DOUBLE_EQ(transition.margin_s(), cutoff_s(0.6, 20.0) + 0.06);
  EXPECT_DOUBLE_EQ(transition.first_margin_s(), cutoff_s(0.6, 20.0) + 0.035);
  EXPECT_DOUBLE_EQ(transition.needed_dx_m(0.5), 0.5 * (transition.margin_s() + 0.1));
}

TEST(Transition, RefusesWhatIsOutOfRange) {
  const PlannerParameters good;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(Transition(good, 0.5, AxisSpec{}));
  EXPECT_THROW(Transition(good, 0.0, AxisSpec{}), ConfigError);
  EXPECT_THROW(Transition(good, nan, AxisSpec{}), ConfigError);
  EXPECT_THROW(Transition(good, 0.5, AxisSpec{.max_velocity_mps = nan}), ConfigError);
  EXPECT_THROW(Transition(good, 0.5, AxisSpec{.max_acceleration_mps2 = -1.0}), ConfigError);
  PlannerParameters bad;
  bad.rho = 0.4;
  EXPECT_THROW(Transition(bad, 0.5, AxisSpec{}), ConfigError);
  bad = {};
  bad.kinematics = "jerk";
  EXPECT_THROW(Transition(bad, 0.5, AxisSpec{}), ConfigError);
}

}  // namespace
}  // namespace furrow::planning
