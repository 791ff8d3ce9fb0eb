#include "furrow_geometry/ground_view.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace furrow::geometry {
namespace {

/// At x 0.3 m and 1.2 m above the ground, tilted forward from looking straight down by a pitch. The
/// optical frame has x to the right (-y of B) and y to the rear.
CameraModel looking_down(double forward_rad) {
  CameraModel camera;
  camera.intrinsics = {641, 481, 400.0, 400.0, 320.0, 240.0};
  Eigen::Matrix3d R_BC;
  R_BC << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  camera.X_BC.linear() =
      Eigen::AngleAxisd(-forward_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() * R_BC;
  camera.X_BC.translation() = Eigen::Vector3d(0.3, 0.0, 1.2);
  return camera;
}

TEST(GroundView, RearEdgeLiesBelowTheLastImageRow) {
  // The last row is 240 px from the centre: 1.2 m * 240 / 400 behind the camera.
  EXPECT_NEAR(rear_view_x_m(looking_down(0.0)), 0.3 - 0.72, 1e-9);
}

TEST(GroundView, ForwardTiltMovesTheRearEdgeForward) {
  // The rear ray points atan(0.6) to the rear of the optical axis.
  const double tilt_rad = 0.3;
  EXPECT_NEAR(rear_view_x_m(looking_down(tilt_rad)),
              0.3 - 1.2 * std::tan(std::atan(0.6) - tilt_rad), 1e-9);
}

TEST(GroundView, CameraThatSeesNoGroundGivesZero) {
  EXPECT_EQ(rear_view_x_m(looking_down(std::numbers::pi)), 0.0);
}

}  // namespace
}  // namespace furrow::geometry
