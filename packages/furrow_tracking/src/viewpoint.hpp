#pragma once

#include <cmath>
#include <optional>

#include "furrow_tracking/observation.hpp"

namespace furrow::tracking {

/// Where the last view was taken that was not a repetition.
class Viewpoint {
 public:
  /// Whether a view is a repetition: from within `distance_m` of the viewpoint. Motion is the
  /// change of the pose beyond its correction, of a point 1 m ahead. Any other view is the new
  /// viewpoint.
  [[nodiscard]] bool repeats(const View& view, double distance_m) {
    constexpr double kReach_m = 1.0;
    if (X_FB_) {
      X_FB_ = geometry::compose(view.correction, *X_FB_);
      const geometry::Pose2 moved = geometry::compose(geometry::inverse(*X_FB_), view.X_FB);
      const double turn_m = kReach_m * std::abs(geometry::wrap_angle_rad(moved.heading_rad));
      if (std::hypot(moved.x_m, moved.y_m) + turn_m < distance_m) return true;
    }
    X_FB_ = view.X_FB;
    return false;
  }

 private:
  std::optional<geometry::Pose2> X_FB_;
};

}  // namespace furrow::tracking
