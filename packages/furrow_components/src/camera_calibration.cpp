#include "furrow_components/camera_calibration.hpp"

#include <algorithm>

namespace furrow::components {

CameraCalibration calibration_of(const sensor_msgs::msg::CameraInfo& message, bool rectified) {
  const auto& k = message.k();
  const auto& p = message.p();
  const auto& roi = message.roi();
  const double binning_x = std::max(1U, message.binning_x());
  const double binning_y = std::max(1U, message.binning_y());
  const bool whole = roi.width() == 0 || roi.height() == 0;
  const double width_px = whole ? message.width() : roi.width();
  const double height_px = whole ? message.height() : roi.height();
  // A binned pixel is the mean of several: its centre lies between theirs.
  const auto binned = [](double c_px, double offset_px, double binning) {
    return (c_px - offset_px + 0.5) / binning - 0.5;
  };
  CameraCalibration calibration;
  calibration.intrinsics = {
      .width_px = static_cast<int>(width_px / binning_x),
      .height_px = static_cast<int>(height_px / binning_y),
      .fx_px = (rectified ? p[0] : k[0]) / binning_x,
      .fy_px = (rectified ? p[5] : k[4]) / binning_y,
      .cx_px = binned(rectified ? p[2] : k[2], whole ? 0.0 : roi.x_offset(), binning_x),
      .cy_px = binned(rectified ? p[6] : k[5], whole ? 0.0 : roi.y_offset(), binning_y)};
  if (!rectified) calibration.distortion = {message.distortion_model(), message.d()};
  return calibration;
}

}  // namespace furrow::components
