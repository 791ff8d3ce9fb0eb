#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_tracking/ground_mask.hpp"
#include "furrow_tracking/ground_region.hpp"

namespace furrow::tracking {

enum class PlantClass : std::uint8_t { kCrop, kWeed };
inline constexpr std::size_t kPlantClasses = 2;
[[nodiscard]] std::string_view to_string(PlantClass plant_class);

/// One plant as one view shows it, already in the field frame F (reprojection.hpp brings it there).
struct Observation {
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();  ///< the stem on the ground
  /// Of p_F_m given the pose: pixel, depth and stem errors. The pose's own error is in View.
  Eigen::Matrix2d covariance_F_m2 = Eigen::Matrix2d::Identity() * 9e-6;
  double radius_m = 0.01;  ///< of the canopy seen from above
  double area_mm2 = 0.0;   ///< leaf area seen from above
  double score = 1.0;      ///< the detector's confidence that this is a plant, [0, 1]
  /// P(class | this view) by PlantClass, not negative, not all zero; normalized on use.
  std::array<double, kPlantClasses> class_probability = {0.5, 0.5};
  /// P(species | this view) by the caller's species table. The rest to 1 belongs to species that
  /// this view does not name. Empty when not known.
  std::vector<float> species_probability = {};
  std::int32_t leaves = 0;  ///< growth stage; 0: not known
  bool truncated = false;   ///< cut by the image's border: radius and area are lower bounds
  GroundMask footprint = {};
};

/// From where and when the observations were made.
struct View {
  Time stamp = {};  ///< the frame's acquisition
  geometry::Pose2 X_FB = {};
  /// Of (x_m, y_m, heading_rad) of X_FB, in F.
  Eigen::Matrix3d pose_covariance = Eigen::Matrix3d::Zero();
  GroundRegion visible = {};  ///< where a plant should be seen now
  /// How the pose was corrected since the view before, as a motion of points in F (PoseCorrection).
  geometry::Pose2 correction = {};
};

}  // namespace furrow::tracking
