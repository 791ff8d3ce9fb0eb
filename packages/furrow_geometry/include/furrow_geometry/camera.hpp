#pragma once

#include <Eigen/Core>
#include <optional>

namespace furrow::geometry {

/// Pinhole intrinsics without distortion, as sensor_msgs/CameraInfo's K holds them. Pixel (0, 0) is
/// the centre of the upper left pixel.
struct CameraIntrinsics {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
};

/// Projection in the optical frame C of ROS (REP 103): x right, y down, z forward.
class PinholeCamera {
 public:
  /// Throws ConfigError when sizes or focal lengths are not positive and finite.
  explicit PinholeCamera(const CameraIntrinsics& intrinsics);

  [[nodiscard]] const CameraIntrinsics& intrinsics() const { return intrinsics_; }

  /// The pixel that sees p_C, also outside the image; empty when p_C is not in front of the
  /// camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_C) const;
  /// The point seen at a pixel with the given depth along z. @pre depth_m > 0.
  [[nodiscard]] Eigen::Vector3d unproject(const Eigen::Vector2d& pixel, double depth_m) const;
  [[nodiscard]] bool in_image(const Eigen::Vector2d& pixel) const;
  /// Area of one pixel on a plane perpendicular to the optical axis, in mm2. Summed over a mask it
  /// gives a plant's size (Halstead et al. 2021).
  [[nodiscard]] double pixel_area_mm2(double depth_m) const;

 private:
  CameraIntrinsics intrinsics_;
};

}  // namespace furrow::geometry
