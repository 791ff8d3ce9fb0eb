#include "furrow_tracking/ground_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace furrow::tracking {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Error invalid(const char* message) {
  return Error{ErrorCode::kInvalidArgument, message};
}

}  // namespace

Result<GroundRegion> GroundRegion::from_corners(std::span<const Eigen::Vector2d> corners_F) {
  if (corners_F.size() < 3 || corners_F.size() > kMaxCorners) {
    return invalid("a ground region needs 3 to 16 corners");
  }
  double twice_area = 0.0;
  double extent = 0.0;
  for (std::size_t i = 0; i < corners_F.size(); ++i) {
    const Eigen::Vector2d& corner = corners_F[i];
    if (!corner.allFinite()) return invalid("a corner of the ground region is not finite");
    const Eigen::Vector2d& next = corners_F[(i + 1) % corners_F.size()];
    twice_area += cross(corner - corners_F[0], next - corners_F[0]);
    extent = std::max(extent, (corner - corners_F[0]).norm());
  }
  const double tolerance_m = 1e-9 * extent;
  if (!(std::abs(twice_area) > tolerance_m * extent)) {
    return invalid("the ground region has no area");
  }

  GroundRegion region;
  region.corners_F_.assign(corners_F.begin(), corners_F.end());
  if (twice_area < 0.0) std::reverse(region.corners_F_.begin(), region.corners_F_.end());
  for (std::size_t i = 0; i < region.corners_F_.size(); ++i) {
    const Eigen::Vector2d edge =
        region.corners_F_[(i + 1) % region.corners_F_.size()] - region.corners_F_[i];
    if (!(edge.norm() > tolerance_m)) return invalid("two corners of the ground region coincide");
    region.inward_normals_F_.push_back(Eigen::Vector2d(-edge.y(), edge.x()).normalized());
  }
  for (const Eigen::Vector2d& corner : region.corners_F_) {
    if (region.depth_inside_m(corner) < -tolerance_m) {
      return invalid("the ground region is not convex");
    }
  }
  return region;
}

Result<GroundRegion> GroundRegion::from_bounds(const Eigen::Vector2d& min_F,
                                               const Eigen::Vector2d& max_F) {
  if (!(max_F.x() > min_F.x()) || !(max_F.y() > min_F.y())) {
    return invalid("the bounds of the ground region are out of order");
  }
  const std::array<Eigen::Vector2d, 4> corners = {min_F, Eigen::Vector2d(max_F.x(), min_F.y()),
                                                  max_F, Eigen::Vector2d(min_F.x(), max_F.y())};
  return from_corners(corners);
}

double GroundRegion::depth_inside_m(const Eigen::Vector2d& p_F) const {
  if (empty()) return -std::numeric_limits<double>::infinity();
  double depth_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners_F_.size(); ++i) {
    depth_m = std::min(depth_m, inward_normals_F_[i].dot(p_F - corners_F_[i]));
  }
  return depth_m;
}

bool GroundRegion::contains(const Eigen::Vector2d& p_F, double margin_m) const {
  return !empty() && depth_inside_m(p_F) >= margin_m;
}

Result<GroundRegion> visible_ground(const geometry::PinholeCamera& camera,
                                    const Eigen::Isometry3d& X_FC, double border_px,
                                    double ground_z_F_m) {
  const geometry::CameraIntrinsics& k = camera.intrinsics();
  if (!X_FC.matrix().allFinite() || !std::isfinite(border_px) || !std::isfinite(ground_z_F_m)) {
    return invalid("pose, border or ground height is not finite");
  }
  const double left = -0.5 + border_px;
  const double right = k.width_px - 0.5 - border_px;
  const double top = -0.5 + border_px;
  const double bottom = k.height_px - 0.5 - border_px;
  if (!(left < right) || !(top < bottom)) return invalid("the border leaves nothing of the image");

  std::array<Eigen::Vector2d, 4> corners;
  const std::array<Eigen::Vector2d, 4> pixels = {
      Eigen::Vector2d(left, top), Eigen::Vector2d(right, top), Eigen::Vector2d(right, bottom),
      Eigen::Vector2d(left, bottom)};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector3d ray_F = X_FC.linear() * camera.unproject(pixels[i], 1.0);
    const double drop_m = ground_z_F_m - X_FC.translation().z();
    // Rays within about half a degree of the horizon count as never reaching the ground.
    if (!(drop_m < 0.0) || !(ray_F.z() < -0.01 * ray_F.norm())) {
      return invalid("a corner of the image does not see the ground");
    }
    corners[i] = (X_FC.translation() + ray_F * (drop_m / ray_F.z())).head<2>();
  }
  return GroundRegion::from_corners(corners);
}

}  // namespace furrow::tracking
