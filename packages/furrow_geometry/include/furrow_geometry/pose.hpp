#pragma once

#include <Eigen/Geometry>

namespace furrow::geometry {

/// Brings an angle into (-pi, pi].
[[nodiscard]] double wrap_angle_rad(double angle_rad);

/// A planar pose X_AB: where frame B stands in frame A. On the ground, x points along the row,
/// y to the left, and the heading is counted counter-clockwise from A's x to B's x.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

/// Planar velocity of a frame B over ground, in B.
struct Twist2 {
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// X_AC from X_AB and X_BC.
[[nodiscard]] Pose2 compose(const Pose2& X_AB, const Pose2& X_BC);
/// X_BA from X_AB.
[[nodiscard]] Pose2 inverse(const Pose2& X_AB);
/// p_A from p_B.
[[nodiscard]] Eigen::Vector2d transform(const Pose2& X_AB, const Eigen::Vector2d& p_B);
/// The spatial pose of a frame that moves on the ground plane: z = 0, no roll, no pitch.
[[nodiscard]] Eigen::Isometry3d to_isometry(const Pose2& X_AB);
/// The planar part of a spatial pose; roll, pitch and height are dropped.
[[nodiscard]] Pose2 to_planar(const Eigen::Isometry3d& X_AB);
/// Linear in position, the shorter way in heading. `fraction` 0 gives `a`, 1 gives `b`; values
/// outside extrapolate.
[[nodiscard]] Pose2 interpolate(const Pose2& a, const Pose2& b, double fraction);

/// The pose after `dt_s` (also negative) of motion with a constant twist, along a circular arc: the
/// exponential map of SE(2) (Lynch and Park 2017, section 3.3.3).
[[nodiscard]] Pose2 extrapolate(const Pose2& X_AB, const Twist2& twist_B, double dt_s);

}  // namespace furrow::geometry
