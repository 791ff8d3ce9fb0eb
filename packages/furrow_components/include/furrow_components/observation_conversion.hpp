#pragma once

#include <Eigen/Geometry>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_tracking/observation.hpp"
#include "furrow_tracking/reprojection.hpp"

namespace furrow::components {

/// Noise and options of the projection from image to ground.
struct ObservationParameters {
  double pixel_noise_px = 1.5;
  double depth_noise_m = 0.005;
  bool footprints = false;
  double footprint_cell_m = 0.002;

  void visit(ParameterVisitor& v);
};

/// The planar covariance, of (x_m, y_m, heading_rad), of a message's 6x6.
[[nodiscard]] Eigen::Matrix3d planar_covariance(const nav_msgs::msg::Odometry& message);

/// One plant of an image, in the field frame, without its species. With `footprints` the mask is
/// projected pixel by pixel at the depth of the stem, as on level ground.
/// Errors: kInvalidArgument for a number that is not finite, kParse for a mask that does not fill
/// its box.
[[nodiscard]] Result<tracking::Observation> observe(const furrow_msgs::msg::PlantInstance& instance,
                                                    const geometry::PinholeCamera& camera,
                                                    const Eigen::Isometry3d& X_FC,
                                                    const ObservationParameters& parameters);

}  // namespace furrow::components
