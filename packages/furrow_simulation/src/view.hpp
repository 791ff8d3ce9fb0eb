#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "furrow_geometry/camera.hpp"
#include "furrow_simulation/light.hpp"

namespace furrow::simulation {

/// A camera at a place.
class View {
 public:
  View(const geometry::CameraIntrinsics& intrinsics, const Eigen::Isometry3d& X_FC)
      : intrinsics_(intrinsics), X_FC_(X_FC), X_CF_(X_FC.inverse()) {}

  [[nodiscard]] const geometry::CameraIntrinsics& intrinsics() const { return intrinsics_; }
  /// In F.
  [[nodiscard]] Eigen::Vector3d position() const { return X_FC_.translation(); }
  /// X_CF.
  [[nodiscard]] const Eigen::Isometry3d& pose_inverse() const { return X_CF_; }
  /// The ray of a pixel in F, one unit long along the optical axis: scaled by the depth it leads
  /// to the point that the pixel sees.
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return X_FC_.linear() * Eigen::Vector3d((pixel.x() - intrinsics_.cx_px) / intrinsics_.fx_px,
                                            (pixel.y() - intrinsics_.cy_px) / intrinsics_.fy_px,
                                            1.0);
  }
  /// From the ray of a pixel to that of the next one to the right.
  [[nodiscard]] Eigen::Vector3d ray_step() const {
    return X_FC_.linear().col(0) / intrinsics_.fx_px;
  }

 private:
  geometry::CameraIntrinsics intrinsics_;
  Eigen::Isometry3d X_FC_;
  Eigen::Isometry3d X_CF_;
};

/// The robot's own shadow: everything behind an edge that moves with the camera.
class RobotShadow {
 public:
  RobotShadow(const LightParameters& light, const View& view) : enabled_(light.robot_shadow) {
    const auto& camera = view.intrinsics();
    const double cosine = std::cos(light.robot_shadow_angle_rad);
    const double sine = std::sin(light.robot_shadow_angle_rad);
    const double height = view.position().z();
    // Metres behind the edge, on level ground, linear in the pixel; softened over 2 cm.
    constexpr double kSoftness_m = 0.02;
    const double per_u = sine * height / camera.fx_px / kSoftness_m;
    const double per_v = cosine * height / camera.fy_px / kSoftness_m;
    u_ = static_cast<float>(per_u);
    v_ = static_cast<float>(per_v);
    offset_ = static_cast<float>(light.robot_shadow_edge_m / kSoftness_m + 0.5 -
                                 per_u * camera.cx_px - per_v * camera.cy_px);
  }

  [[nodiscard]] bool enabled() const { return enabled_; }
  /// The factor on the brightness of something that keeps the share `shade` of it in full shadow.
  [[nodiscard]] float gain(int u, int v, float shade) const {
    const float depth = u_ * static_cast<float>(u) + v_ * static_cast<float>(v) + offset_;
    const float share = depth < 0.0f ? 0.0f : (depth > 1.0f ? 1.0f : depth);
    return 1.0f - share * (1.0f - shade);
  }

 private:
  bool enabled_;
  float u_ = 0.0f;
  float v_ = 0.0f;
  float offset_ = 0.0f;
};

}  // namespace furrow::simulation
