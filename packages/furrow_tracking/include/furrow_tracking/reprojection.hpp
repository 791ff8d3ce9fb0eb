#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "furrow_core/result.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_tracking/ground_mask.hpp"

namespace furrow::tracking {

/// A depth image: metres along the optical axis, row-major, not owned. Values that are not positive
/// and finite mean "no depth".
struct DepthImage {
  const float* data_m = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride = 0;  ///< values from one row to the next
};

/// An instance's mask within its box: non-zero where the plant is, row-major, not owned. (u0, v0)
/// is the box's upper left pixel in the image.
struct InstanceMask {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride = 0;
  int u0_px = 0;
  int v0_px = 0;
};

/// Standard deviations that reproject_point carries into the field frame.
struct PixelNoise {
  double pixel_px = 1.5;
  double depth_m = 0.005;
};

struct GroundPoint {
  Eigen::Vector3d p_F_m = Eigen::Vector3d::Zero();
  /// Of x and y, to first order, the pose taken as exact.
  Eigen::Matrix2d covariance_F_m2 = Eigen::Matrix2d::Identity();
};

/// The point seen at `pixel` with the given depth, in the field frame. kInvalidArgument: pixel,
/// depth, pose or noise not finite, depth or noise not positive.
[[nodiscard]] Result<GroundPoint> reproject_point(const geometry::PinholeCamera& camera,
                                                  const Eigen::Isometry3d& X_FC,
                                                  const Eigen::Vector2d& pixel, double depth_m,
                                                  const PixelNoise& noise = {});

/// The median of the valid depths within `half_width_px` around `pixel`. kNotFound: none is valid.
/// kInvalidArgument: the image is malformed, the pixel not in it, or the width not in [0, 64].
[[nodiscard]] Result<double> depth_near(const DepthImage& depth, const Eigen::Vector2d& pixel,
                                        int half_width_px = 2);

struct GroundFootprint {
  GroundMask mask;
  double area_mm2 = 0.0;  ///< sum of the pixels' areas at their depths (Halstead et al. 2021)
  double radius_m = 0.0;  ///< of the circle that encloses the mask about its centroid
  std::int64_t pixels_without_depth = 0;
};

/// Projects each pixel of a mask by its depth and the camera's pose into the field frame. Pixels
/// without depth are omitted and counted. kInvalidArgument: malformed image, box outside the depth
/// image, invalid cell or pose. kNotFound: no pixel of the mask has a depth.
[[nodiscard]] Result<GroundFootprint> reproject_mask(const geometry::PinholeCamera& camera,
                                                     const Eigen::Isometry3d& X_FC,
                                                     const InstanceMask& mask,
                                                     const DepthImage& depth,
                                                     double cell_m = 0.002);

}  // namespace furrow::tracking
