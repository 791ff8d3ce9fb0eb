#include "furrow_vision/rectifier.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace furrow::vision {
namespace {

using geometry::Distortion;

const geometry::CameraIntrinsics kIntrinsics{.width_px = 320,
                                             .height_px = 240,
                                             .fx_px = 260.0,
                                             .fy_px = 255.0,
                                             .cx_px = 158.0,
                                             .cy_px = 122.0};

/// Where the lens shows a direction (x, y, 1), by the formulas of OpenCV's documentation ("Camera
/// Calibration and 3D Reconstruction", "Fisheye camera model").
Eigen::Vector2d seen_at(const Distortion& distortion, double x, double y) {
  const std::vector<double>& c = distortion.coefficients;
  const double r2 = x * x + y * y;
  double u = x;
  double v = y;
  if (distortion.model == "equidistant") {
    const double r = std::sqrt(r2);
    const double angle = std::atan(r);
    const double a2 = angle * angle;
    const double bent = angle * (1.0 + a2 * (c[0] + a2 * (c[1] + a2 * (c[2] + a2 * c[3]))));
    const double scale = r > 0.0 ? bent / r : 1.0;
    u = x * scale;
    v = y * scale;
  } else {
    double radial = 1.0 + r2 * (c[0] + r2 * (c[1] + r2 * c[4]));
    if (c.size() == 8) radial /= 1.0 + r2 * (c[5] + r2 * (c[6] + r2 * c[7]));
    u = x * radial + 2.0 * c[2] * x * y + c[3] * (r2 + 2.0 * x * x);
    v = y * radial + c[2] * (r2 + 2.0 * y * y) + 2.0 * c[3] * x * y;
  }
  return {kIntrinsics.fx_px * u + kIntrinsics.cx_px, kIntrinsics.fy_px * v + kIntrinsics.cy_px};
}

/// The centre of what is bright, px.
Eigen::Vector2d centre_of(const cv::Mat& image) {
  const cv::Moments moments = cv::moments(image);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

class RectifierTest : public testing::TestWithParam<Distortion> {};

TEST_P(RectifierTest, ADotAppearsWhereAPinholeWouldShowIt) {
  const auto rectifier = Rectifier::make(kIntrinsics, GetParam());
  ASSERT_TRUE(rectifier.ok()) << rectifier.error().message;
  for (const double x : {-0.45, -0.2, 0.0, 0.3, 0.5}) {
    for (const double y : {-0.35, 0.0, 0.1, 0.35}) {
      const Eigen::Vector2d raw = seen_at(GetParam(), x, y);
      cv::Mat image(kIntrinsics.height_px, kIntrinsics.width_px, CV_8UC1, cv::Scalar(0));
      constexpr int kShift = 6;
      cv::circle(image, cv::Point(cvRound(raw.x() * 64), cvRound(raw.y() * 64)), 4 * 64,
                 cv::Scalar(255), cv::FILLED, cv::LINE_AA, kShift);
      const Eigen::Vector2d expected(kIntrinsics.fx_px * x + kIntrinsics.cx_px,
                                     kIntrinsics.fy_px * y + kIntrinsics.cy_px);
      EXPECT_LT((centre_of(rectifier->colour(image)) - expected).norm(), 0.5) << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, RectifierTest,
    testing::Values(Distortion{"plumb_bob", {-0.25, 0.08, 0.001, -0.002, -0.01}},
                    Distortion{"rational_polynomial",
                               {0.5, -0.2, 0.001, 0.0005, 0.02, 0.8, -0.1, 0.03}},
                    Distortion{"equidistant", {-0.02, 0.005, -0.001, 0.0002}}),
    [](const auto& lens) { return lens.param.model; });

TEST(Rectifier, WithoutDistortionTheImagePassesWithoutACopy) {
  const cv::Mat image(kIntrinsics.height_px, kIntrinsics.width_px, CV_8UC3, cv::Scalar(1, 2, 3));
  for (const Distortion& none : {Distortion{}, Distortion{"plumb_bob", {0, 0, 0, 0, 0}},
                                 Distortion{"plumb_bob", {}}, Distortion{"", {}}}) {
    const auto rectifier = Rectifier::make(kIntrinsics, none);
    ASSERT_TRUE(rectifier.ok());
    EXPECT_TRUE(rectifier->identity());
    EXPECT_EQ(rectifier->colour(image).data, image.data);
    EXPECT_EQ(rectifier->depth(image).data, image.data);
  }
}

// An equidistant lens with zero coefficients is no pinhole: its radius grows with the angle.
TEST(Rectifier, AnEquidistantLensIsNeverThePinhole) {
  const auto rectifier = Rectifier::make(kIntrinsics, {"equidistant", {0, 0, 0, 0}});
  ASSERT_TRUE(rectifier.ok());
  EXPECT_FALSE(rectifier->identity());
}

TEST(Rectifier, DepthsAreNotMixed) {
  const auto rectifier = Rectifier::make(kIntrinsics, {"plumb_bob", {-0.25, 0.08, 0.0, 0.0, 0.0}});
  ASSERT_TRUE(rectifier.ok());
  cv::Mat depth_m(kIntrinsics.height_px, kIntrinsics.width_px, CV_32FC1, cv::Scalar(1.0));
  depth_m.colRange(0, 160).setTo(2.0);
  const cv::Mat rectified_m = rectifier->depth(depth_m);
  for (const float depth : cv::Mat_<float>(rectified_m)) {
    EXPECT_TRUE(depth == 0.0F || depth == 1.0F || depth == 2.0F) << depth;
  }
}

TEST(Rectifier, RefusesWhatItDoesNotKnow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Rectifier::make(kIntrinsics, {"thin_prism", {0.1, 0, 0, 0, 0}}).ok());
  EXPECT_FALSE(Rectifier::make(kIntrinsics, {"plumb_bob", {0.1, 0, 0, 0}}).ok());
  EXPECT_FALSE(Rectifier::make(kIntrinsics, {"equidistant", {0.1, 0, 0, 0, 0}}).ok());
  EXPECT_FALSE(Rectifier::make(kIntrinsics, {"plumb_bob", {nan, 0, 0, 0, 0}}).ok());
}

}  // namespace
}  // namespace furrow::vision
