#pragma once

#include "furrow_geometry/camera.hpp"
#include "furrow_geometry/distortion.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

struct CameraCalibration {
  geometry::CameraIntrinsics intrinsics;
  geometry::Distortion distortion;
};

/// Of the images as they are sent: K, D and the model, after region of interest and binning (REP
/// 104). `rectified`: the images are free of distortion already, so that P counts and D does not.
/// Values are not checked.
[[nodiscard]] CameraCalibration calibration_of(const sensor_msgs::msg::CameraInfo& message,
                                               bool rectified);

}  // namespace furrow::components
