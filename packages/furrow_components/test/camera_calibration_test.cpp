#include "furrow_components/camera_calibration.hpp"

#include <gtest/gtest.h>

namespace furrow::components {
namespace {

sensor_msgs::msg::CameraInfo full_image() {
  sensor_msgs::msg::CameraInfo info;
  info.width(1280);
  info.height(960);
  info.k({900.0, 0.0, 641.0, 0.0, 910.0, 470.0, 0.0, 0.0, 1.0});
  info.p({800.0, 0.0, 630.0, 0.0, 0.0, 810.0, 480.0, 0.0, 0.0, 0.0, 1.0, 0.0});
  info.distortion_model("plumb_bob");
  info.d({-0.2, 0.1, 0.0, 0.0, 0.0});
  return info;
}

TEST(CameraCalibration, IsThatOfTheWholeImage) {
  const CameraCalibration calibration = calibration_of(full_image(), false);
  EXPECT_EQ(calibration.intrinsics.width_px, 1280);
  EXPECT_EQ(calibration.intrinsics.height_px, 960);
  EXPECT_EQ(calibration.intrinsics.fx_px, 900.0);
  EXPECT_EQ(calibration.intrinsics.fy_px, 910.0);
  EXPECT_EQ(calibration.intrinsics.cx_px, 641.0);
  EXPECT_EQ(calibration.intrinsics.cy_px, 470.0);
  EXPECT_EQ(calibration.distortion.model, "plumb_bob");
  EXPECT_EQ(calibration.distortion.coefficients.size(), 5U);
}

TEST(CameraCalibration, OfRectifiedImagesIsTheProjectionWithoutDistortion) {
  const CameraCalibration calibration = calibration_of(full_image(), true);
  EXPECT_EQ(calibration.intrinsics.fx_px, 800.0);
  EXPECT_EQ(calibration.intrinsics.fy_px, 810.0);
  EXPECT_EQ(calibration.intrinsics.cx_px, 630.0);
  EXPECT_EQ(calibration.intrinsics.cy_px, 480.0);
  EXPECT_EQ(calibration.distortion, geometry::Distortion());
}

// The same direction must be seen by the same piece of the sensor. Sensor pixel 700 lies in the
// region's pixel 600, which is the lower half of the binned pixel 300: between 299.75 and 300.
TEST(CameraCalibration, FollowsRegionOfInterestAndBinning) {
  sensor_msgs::msg::CameraInfo info = full_image();
  info.roi().x_offset(100);
  info.roi().y_offset(40);
  info.roi().width(800);
  info.roi().height(600);
  info.binning_x(2);
  info.binning_y(2);
  const CameraCalibration calibration = calibration_of(info, false);
  EXPECT_EQ(calibration.intrinsics.width_px, 400);
  EXPECT_EQ(calibration.intrinsics.height_px, 300);
  const double x = (700.0 - 641.0) / 900.0;
  EXPECT_NEAR(calibration.intrinsics.fx_px * x + calibration.intrinsics.cx_px, 299.75, 1e-9);
  // The region's first two rows, 40 and 41 of the sensor, meet at 40.5: the centre of row 0.
  const double y = (40.5 - 470.0) / 910.0;
  EXPECT_NEAR(calibration.intrinsics.fy_px * y + calibration.intrinsics.cy_px, 0.0, 1e-9);
}

}  // namespace
}  // namespace furrow::components
