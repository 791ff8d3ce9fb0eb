#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_geometry/camera.hpp"

namespace furrow::tracking {

/// A convex polygon on the ground plane z = 0 of the field frame F, at most 16 corners, in metres.
/// The empty region holds no point.
class GroundRegion {
 public:
  static constexpr std::size_t kMaxCorners = 16;

  GroundRegion() = default;
  /// Corners in order, either way round. kInvalidArgument: fewer than 3 or more than kMaxCorners,
  /// not finite, not convex, or without area.
  [[nodiscard]] static Result<GroundRegion> from_corners(
      std::span<const Eigen::Vector2d> corners_F);
  /// The rectangle between two opposite corners.
  [[nodiscard]] static Result<GroundRegion> from_bounds(const Eigen::Vector2d& min_F,
                                                        const Eigen::Vector2d& max_F);

  /// Distance inwards from the nearest edge's line, in metres; negative outside.
  [[nodiscard]] double depth_inside_m(const Eigen::Vector2d& p_F) const;
  /// Whether p_F lies inside by at least `margin_m` (a negative margin reaches outwards).
  [[nodiscard]] bool contains(const Eigen::Vector2d& p_F, double margin_m = 0.0) const;

  [[nodiscard]] bool empty() const { return corners_F_.empty(); }
  /// In F, counter-clockwise.
  [[nodiscard]] const std::vector<Eigen::Vector2d>& corners() const { return corners_F_; }

 private:
  std::vector<Eigen::Vector2d> corners_F_;
  std::vector<Eigen::Vector2d> inward_normals_F_;
};

/// The visible ground: the image's outline, moved inwards by `border_px` and projected onto the
/// plane z = `ground_z_F_m`.
/// - kInvalidArgument: the border covers the image, or the ray of a corner misses the ground.
[[nodiscard]] Result<GroundRegion> visible_ground(const geometry::PinholeCamera& camera,
                                                  const Eigen::Isometry3d& X_FC,
                                                  double border_px = 0.0,
                                                  double ground_z_F_m = 0.0);

}  // namespace furrow::tracking
