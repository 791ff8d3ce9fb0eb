#include "furrow_actuation/crossing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "furrow_core/random.hpp"

namespace furrow::actuation {
namespace {

geometry::AxisModel axis_at(double x_m) {
  geometry::AxisModel axis;
  axis.p_BN0 = {x_m, 0.0, 0.6};
  axis.lower_m = -0.695;
  axis.upper_m = 0.695;
  axis.nozzle.height_m = 0.6;
  axis.nozzle.footprint_radius_m = 0.025;
  return axis;
}

TEST(FallTime, AgreesWithAnIntegratedFall) {
  for (const double speed : {0.0, 2.0, 10.0}) {
    double height = 0.6;
    double v = speed;
    double t = 0.0;
    while (height > 0.0) {
      v += 9.80665e-6;
      height -= v * 1e-6;
      t += 1e-6;
    }
    EXPECT_NEAR(fall_time_s(0.6, speed), t, 1e-5);
  }
}

TEST(Extrapolate, AgreesWithAnIntegratedArc) {
  const BaseState base{Time::from_seconds(5.0), {1.0, -0.5, 0.4}, {0.8, 0.05, 0.3}};
  geometry::Pose2 pose = base.X_FB;
  for (int i = 0; i < 200000; ++i) {
    const double h = 1e-5;
    const double heading = pose.heading_rad + 0.3 * h / 2.0;
    pose.x_m += h * (0.8 * std::cos(heading) - 0.05 * std::sin(heading));
    pose.y_m += h * (0.8 * std::sin(heading) + 0.05 * std::cos(heading));
    pose.heading_rad += 0.3 * h;
  }
  const BaseState later = extrapolate(base, Time::from_seconds(7.0));
  EXPECT_NEAR(later.X_FB.x_m, pose.x_m, 1e-8);
  EXPECT_NEAR(later.X_FB.y_m, pose.y_m, 1e-8);
  EXPECT_NEAR(later.X_FB.heading_rad, pose.heading_rad, 1e-8);
}

TEST(Crossing, StraightDriveIsTheTextbookCase) {
  const BaseState base{Time::from_seconds(10.0), {2.0, 0.1, 0.0}, {0.5, 0.0, 0.0}};
  const geometry::AxisModel axis = axis_at(0.18);
  // Without carry the droplets fall straight: the nozzle itself must be over the target.
  const auto still = predict_crossing(base, axis, {0.06, 0.0}, {3.18, 0.4}, 0.0, {});
  ASSERT_TRUE(still.ok());
  EXPECT_NEAR(still->emission.to_seconds(), 10.0 + 1.0 / 0.5, 1e-9);
  EXPECT_NEAR(still->q_m, 0.3, 1e-9);
  EXPECT_NEAR(still->closing_speed_mps, 0.5, 1e-12);
  EXPECT_NEAR((still->landing - still->emission).to_seconds(), 0.06, 1e-9);
  // With carry they fly 0.06 s * 0.5 m/s ahead, and with the axis 0.06 s * 1 m/s to the side.
  const auto carried = predict_crossing(base, axis, {0.06, 1.0}, {3.18, 0.4}, 1.0, {});
  ASSERT_TRUE(carried.ok());
  EXPECT_NEAR(carried->emission.to_seconds(), 10.0 + (1.0 - 0.03) / 0.5, 1e-9);
  EXPECT_NEAR(carried->q_m, 0.3 - 0.06, 1e-9);
}

TEST(Crossing, DropletsLandOnTheTarget) {
  Random random(1, "crossing");
  int found = 0;
  for (int i = 0; i < 3000; ++i) {
    const BaseState base{
        Time::from_seconds(random.uniform(0.0, 100.0)),
        {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3, 3)},
        {random.uniform(0.1, 1.5), random.uniform(-0.05, 0.05), random.uniform(-0.2, 0.2)}};
    geometry::AxisModel axis = axis_at(random.uniform(-0.3, 0.3));
    const double tilt = random.uniform(-0.4, 0.4);
    axis.direction_B = {std::sin(tilt), std::cos(tilt) * (random.bernoulli(0.5) ? 1.0 : -1.0), 0.0};
    const DropletModel droplet{random.uniform(0.0, 0.3), random.uniform()};
    const double speed = random.uniform(-2.0, 2.0);
    const Eigen::Vector2d p_F =
        geometry::transform(base.X_FB, {random.uniform(-0.2, 2.0), random.uniform(-0.7, 0.7)});
    const auto crossing = predict_crossing(base, axis, droplet, p_F, speed, {});
    if (!crossing.ok()) continue;
    ++found;
    // Two positions of the nozzle shortly around the emission give its velocity over ground.
    const auto nozzle_F = [&](double dt) {
      const BaseState at = extrapolate(base, crossing->emission + Duration::seconds(dt));
      return geometry::transform(
          at.X_FB, axis.nozzle_position_B(crossing->q_m + speed * dt).head<2>().eval());
    };
    const Eigen::Vector2d velocity_F = (nozzle_F(1e-4) - nozzle_F(-1e-4)) / 2e-4;
    const Eigen::Vector2d landing_F = nozzle_F(0.0) + droplet.carry * droplet.fall_s * velocity_F;
    ASSERT_LT((landing_F - p_F).norm(), 1e-6);
    const BaseState at = extrapolate(base, crossing->emission);
    ASSERT_LT((landing_point(at, axis, droplet, crossing->q_m, speed) - p_F).norm(), 1e-7);
  }
  EXPECT_GT(found, 2900);
}

TEST(Crossing, ATargetBehindHasCrossedBefore) {
  const BaseState base{Time::from_seconds(10.0), {0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}};
  const auto crossing = predict_crossing(base, axis_at(0.18), {}, {0.08, 0.0}, 0.0, {});
  ASSERT_TRUE(crossing.ok());
  EXPECT_NEAR(crossing->emission.to_seconds(), 9.8, 1e-9);
}

TEST(Crossing, StandingReversingAndBadInputHaveNone) {
  const geometry::AxisModel axis = axis_at(0.18);
  BaseState base{Time::from_seconds(10.0), {}, {0.0, 0.0, 0.0}};
  const auto code = [&](const Eigen::Vector2d& p_F) {
    return predict_crossing(base, axis, {}, p_F, 0.0, {}).error().code;
  };
  EXPECT_EQ(code({1.0, 0.0}), ErrorCode::kNoSolution);
  base.twist_B.vx_mps = -0.5;
  EXPECT_EQ(code({1.0, 0.0}), ErrorCode::kNoSolution);
  base.twist_B = {0.0, 0.0, -0.5};  // turning on the spot moves nozzles, but is not driving
  EXPECT_EQ(code({0.3, 0.5}), ErrorCode::kNoSolution);
  base.twist_B = {0.5, 0.0, 0.0};
  EXPECT_EQ(code({1000.0, 0.0}), ErrorCode::kNoSolution);
  EXPECT_EQ(code({std::numeric_limits<double>::quiet_NaN(), 0.0}), ErrorCode::kInvalidArgument);
  base.twist_B.vx_mps = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code({1.0, 0.0}), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::actuation
