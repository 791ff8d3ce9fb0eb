#include "furrow_geometry/camera.hpp"

#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::geometry {

PinholeCamera::PinholeCamera(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  if (intrinsics.width_px <= 0 || intrinsics.height_px <= 0) {
    throw ConfigError("camera: the image size must be positive");
  }
  const bool focal = std::isfinite(intrinsics.fx_px) && intrinsics.fx_px > 0.0 &&
                     std::isfinite(intrinsics.fy_px) && intrinsics.fy_px > 0.0;
  if (!focal || !std::isfinite(intrinsics.cx_px) || !std::isfinite(intrinsics.cy_px)) {
    throw ConfigError("camera: focal lengths must be positive and all intrinsics finite");
  }
}

std::optional<Eigen::Vector2d> PinholeCamera::project(const Eigen::Vector3d& p_C) const {
  if (!(p_C.z() > 0.0)) return std::nullopt;
  return Eigen::Vector2d(intrinsics_.fx_px * p_C.x() / p_C.z() + intrinsics_.cx_px,
                         intrinsics_.fy_px * p_C.y() / p_C.z() + intrinsics_.cy_px);
}

Eigen::Vector3d PinholeCamera::unproject(const Eigen::Vector2d& pixel, double depth_m) const {
  return {(pixel.x() - intrinsics_.cx_px) / intrinsics_.fx_px * depth_m,
          (pixel.y() - intrinsics_.cy_px) / intrinsics_.fy_px * depth_m, depth_m};
}

bool PinholeCamera::in_image(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < intrinsics_.width_px - 0.5 &&
         pixel.y() < intrinsics_.height_px - 0.5;
}

double PinholeCamera::pixel_area_mm2(double depth_m) const {
  return 1e6 * depth_m * depth_m / (intrinsics_.fx_px * intrinsics_.fy_px);
}

}  // namespace furrow::geometry
