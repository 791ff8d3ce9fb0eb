#include "furrow_geometry/pose.hpp"

#include <cmath>
#include <numbers>

namespace furrow::geometry {

double wrap_angle_rad(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

Pose2 compose(const Pose2& X_AB, const Pose2& X_BC) {
  const Eigen::Vector2d p_AC = transform(X_AB, {X_BC.x_m, X_BC.y_m});
  return {p_AC.x(), p_AC.y(), wrap_angle_rad(X_AB.heading_rad + X_BC.heading_rad)};
}

Pose2 inverse(const Pose2& X_AB) {
  const double c = std::cos(X_AB.heading_rad);
  const double s = std::sin(X_AB.heading_rad);
  return {-c * X_AB.x_m - s * X_AB.y_m, s * X_AB.x_m - c * X_AB.y_m,
          wrap_angle_rad(-X_AB.heading_rad)};
}

Eigen::Vector2d transform(const Pose2& X_AB, const Eigen::Vector2d& p_B) {
  const double c = std::cos(X_AB.heading_rad);
  const double s = std::sin(X_AB.heading_rad);
  return {X_AB.x_m + c * p_B.x() - s * p_B.y(), X_AB.y_m + s * p_B.x() + c * p_B.y()};
}

Eigen::Isometry3d to_isometry(const Pose2& X_AB) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() << X_AB.x_m, X_AB.y_m, 0.0;
  X.linear() = Eigen::AngleAxisd(X_AB.heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return X;
}

Pose2 to_planar(const Eigen::Isometry3d& X_AB) {
  return {X_AB.translation().x(), X_AB.translation().y(),
          std::atan2(X_AB.linear()(1, 0), X_AB.linear()(0, 0))};
}

Pose2 interpolate(const Pose2& a, const Pose2& b, double fraction) {
  const double turn_rad = wrap_angle_rad(b.heading_rad - a.heading_rad);
  return {a.x_m + fraction * (b.x_m - a.x_m), a.y_m + fraction * (b.y_m - a.y_m),
          wrap_angle_rad(a.heading_rad + fraction * turn_rad)};
}

Pose2 extrapolate(const Pose2& X_AB, const Twist2& twist_B, double dt_s) {
  const double turn = twist_B.yaw_rate_radps * dt_s;
  // The displacement along an arc, by series where the turn is small.
  const double sinc = std::abs(turn) < 1e-6 ? 1.0 - turn * turn / 6.0 : std::sin(turn) / turn;
  const double cosc = std::abs(turn) < 1e-6 ? turn / 2.0 : (1.0 - std::cos(turn)) / turn;
  return compose(X_AB, {dt_s * (sinc * twist_B.vx_mps - cosc * twist_B.vy_mps),
                        dt_s * (cosc * twist_B.vx_mps + sinc * twist_B.vy_mps), turn});
}

}  // namespace furrow::geometry
