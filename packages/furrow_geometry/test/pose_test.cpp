#include "furrow_geometry/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "furrow_core/random.hpp"

namespace furrow::geometry {
namespace {

constexpr double kPi = std::numbers::pi;

Pose2 random_pose(Random& random) {
  return {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-kPi, kPi)};
}

void expect_same(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x_m, b.x_m, 1e-9);
  EXPECT_NEAR(a.y_m, b.y_m, 1e-9);
  EXPECT_NEAR(wrap_angle_rad(a.heading_rad - b.heading_rad), 0.0, 1e-9);
}

TEST(WrapAngle, StaysInTheHalfOpenRangeAndKeepsTheDirection) {
  EXPECT_DOUBLE_EQ(wrap_angle_rad(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle_rad(-kPi), kPi);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double angle_rad = random.uniform(-100, 100);
    const double wrapped_rad = wrap_angle_rad(angle_rad);
    EXPECT_GT(wrapped_rad, -kPi);
    EXPECT_LE(wrapped_rad, kPi);
    EXPECT_NEAR(std::cos(wrapped_rad), std::cos(angle_rad), 1e-12);
    EXPECT_NEAR(std::sin(wrapped_rad), std::sin(angle_rad), 1e-12);
  }
}

TEST(Pose2, ComposesByHand) {
  // B stands 2 m ahead of A and looks to A's left; C stands 1 m ahead of B.
  expect_same(compose({2, 0, kPi / 2}, {1, 0, 0}), {2, 1, kPi / 2});
}

TEST(Pose2, AgreesWithHomogeneousMatrices) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Pose2 X_AB = random_pose(random);
    const Pose2 X_BC = random_pose(random);
    expect_same(compose(X_AB, X_BC), to_planar(to_isometry(X_AB) * to_isometry(X_BC)));
    expect_same(inverse(X_AB), to_planar(to_isometry(X_AB).inverse()));
    expect_same(compose(X_AB, inverse(X_AB)), {});
    const Eigen::Vector2d p_B(random.uniform(-5, 5), random.uniform(-5, 5));
    const Eigen::Vector3d p_A = to_isometry(X_AB) * Eigen::Vector3d(p_B.x(), p_B.y(), 0.0);
    EXPECT_NEAR((transform(X_AB, p_B) - p_A.head<2>()).norm(), 0.0, 1e-9);
  }
}

TEST(Pose2, InterpolatesTheShorterWayRound) {
  const Pose2 a{0, 0, kPi - 0.1};
  const Pose2 b{2, 4, -kPi + 0.1};
  expect_same(interpolate(a, b, 0.0), a);
  expect_same(interpolate(a, b, 1.0), b);
  expect_same(interpolate(a, b, 0.5), {1, 2, kPi});
  expect_same(interpolate(a, b, 1.5), {3, 6, -kPi + 0.2});
}

TEST(Extrapolate, FollowsACircle) {
  // A quarter of a circle of radius 2 m to the left, in 1 s.
  const double quarter = 0.5 * std::numbers::pi;
  const Pose2 end = extrapolate({1.0, -1.0, 0.0}, {2.0 * quarter, 0.0, quarter}, 1.0);
  EXPECT_NEAR(end.x_m, 3.0, 1e-12);
  EXPECT_NEAR(end.y_m, 1.0, 1e-12);
  EXPECT_NEAR(end.heading_rad, quarter, 1e-12);
}

TEST(Extrapolate, AgreesWithManySmallSteps) {
  const Twist2 twist{0.6, -0.1, 0.7};
  Pose2 stepped{0.2, 0.1, 2.9};
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {
    const double dt_s = 3.0 / kSteps;
    stepped = compose(stepped, {twist.vx_mps * dt_s, twist.vy_mps * dt_s, 0.7 * dt_s});
  }
  const Pose2 end = extrapolate({0.2, 0.1, 2.9}, twist, 3.0);
  EXPECT_NEAR(end.x_m, stepped.x_m, 1e-5);
  EXPECT_NEAR(end.y_m, stepped.y_m, 1e-5);
  EXPECT_NEAR(wrap_angle_rad(end.heading_rad - stepped.heading_rad), 0.0, 1e-9);
}

TEST(Extrapolate, BackAgainIsWhereItBegan) {
  const Pose2 start{0.3, -0.2, 1.1};
  for (const double yaw_rate : {0.0, 1e-9, 1e-6, 0.3}) {
    const Twist2 twist{0.5, 0.05, yaw_rate};
    const Pose2 back = extrapolate(extrapolate(start, twist, 0.7), twist, -0.7);
    EXPECT_NEAR(back.x_m, start.x_m, 1e-9);
    EXPECT_NEAR(back.y_m, start.y_m, 1e-9);
    EXPECT_NEAR(back.heading_rad, start.heading_rad, 1e-12);
  }
}

}  // namespace
}  // namespace furrow::geometry
