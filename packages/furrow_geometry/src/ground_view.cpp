#include "furrow_geometry/ground_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::geometry {

double rear_view_x_m(const CameraModel& camera) {
  const PinholeCamera pinhole(camera.intrinsics);
  const Eigen::Vector3d origin_B = camera.X_BC.translation();
  double rear_m = std::numeric_limits<double>::infinity();
  for (const double u_px : {0.0, camera.intrinsics.width_px - 1.0}) {
    for (const double v_px : {0.0, camera.intrinsics.height_px - 1.0}) {
      const Eigen::Vector3d ray_B = camera.X_BC.linear() * pinhole.unproject({u_px, v_px}, 1.0);
      if (ray_B.z() >= 0.0) continue;
      rear_m = std::min(rear_m, (origin_B - origin_B.z() / ray_B.z() * ray_B).x());
    }
  }
  return std::isfinite(rear_m) ? rear_m : 0.0;
}

}  // namespace furrow::geometry
