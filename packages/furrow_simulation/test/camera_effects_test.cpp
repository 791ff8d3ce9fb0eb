#include "furrow_simulation/camera_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow::simulation {
namespace {

struct Pictures {
  cv::Mat bgr{cv::Size(400, 300), CV_8UC3, cv::Scalar(100, 128, 160)};
  cv::Mat depth_m{cv::Size(400, 300), CV_32FC1, cv::Scalar(1.0)};
};

TEST(CameraEffects, NoneChangesNothing) {
  Pictures p;
  CameraEffects(CameraEffectParameters::none(), 1).apply(p.bgr, p.depth_m, 0, true, 1);
  EXPECT_EQ(cv::norm(p.bgr, Pictures().bgr, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(p.depth_m, Pictures().depth_m, cv::NORM_INF), 0.0);
}

TEST(CameraEffects, NoiseHasItsDeviation) {
  Pictures p;
  auto parameters = CameraEffectParameters::none();
  parameters.image_noise = 4.0;
  parameters.depth_noise_m = 0.003;
  CameraEffects(parameters, 1).apply(p.bgr, p.depth_m, 0, true, 1);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(p.bgr, mean, deviation);
  EXPECT_NEAR(mean[1], 128.0, 0.6);
  EXPECT_NEAR(deviation[1], 4.0, 0.4);
  EXPECT_LT(deviation[0], deviation[2]) << "brighter pixels are noisier";
  cv::meanStdDev(p.depth_m, mean, deviation);
  EXPECT_NEAR(mean[0], 1.0, 1e-4);
  EXPECT_NEAR(deviation[0], 0.003, 1e-4);
}

TEST(CameraEffects, BlurKeepsTheBrightnessOfAPoint) {
  for (const bool along_columns : {true, false}) {
    cv::Mat bgr(cv::Size(64, 64), CV_8UC3, cv::Scalar(0, 0, 0));
    cv::Mat depth_m(cv::Size(64, 64), CV_32FC1, cv::Scalar(1.0));
    bgr(cv::Rect(30, 30, 3, 3)).setTo(cv::Scalar(240, 240, 240));
    auto parameters = CameraEffectParameters::none();
    parameters.motion_blur_px = 7.0;
    CameraEffects(parameters, 1).apply(bgr, depth_m, 0, along_columns, 1);
    EXPECT_NEAR(cv::sum(bgr)[0], 9 * 240.0, 60.0);
    const cv::Vec3b along = along_columns ? bgr.at<cv::Vec3b>(28, 31) : bgr.at<cv::Vec3b>(31, 28);
    const cv::Vec3b across = along_columns ? bgr.at<cv::Vec3b>(31, 28) : bgr.at<cv::Vec3b>(28, 31);
    EXPECT_GT(along[0], 50);
    EXPECT_EQ(across[0], 0);
  }
}

TEST(CameraEffects, VignettingDarkensTheCorners) {
  Pictures p;
  auto parameters = CameraEffectParameters::none();
  parameters.vignetting = 0.4;
  CameraEffects(parameters, 1).apply(p.bgr, p.depth_m, 0, true, 1);
  EXPECT_NEAR(p.bgr.at<cv::Vec3b>(150, 200)[1], 128, 2);
  EXPECT_NEAR(p.bgr.at<cv::Vec3b>(0, 0)[1], 0.6 * 128, 3);
}

TEST(CameraEffects, HolesAndStepsLoseDepth) {
  Pictures p;
  p.depth_m.colRange(200, 400).setTo(0.9f);
  auto parameters = CameraEffectParameters::none();
  parameters.depth_hole_share = 0.1;
  CameraEffects(parameters, 1).apply(p.bgr, p.depth_m, 0, true, 1);
  EXPECT_NEAR(1.0 - cv::countNonZero(p.depth_m) / 120000.0, 0.1, 0.02);

  Pictures q;
  q.depth_m.colRange(200, 400).setTo(0.9f);
  parameters = CameraEffectParameters::none();
  parameters.depth_edge_step_m = 0.05;
  CameraEffects(parameters, 1).apply(q.bgr, q.depth_m, 0, true, 1);
  const int lost = 120000 - cv::countNonZero(q.depth_m);
  EXPECT_NEAR(lost, 300, 60) << "half of the two columns at the step";
  EXPECT_EQ(cv::countNonZero(q.depth_m.colRange(0, 199)), 199 * 300);
}

}  // namespace
}  // namespace furrow::simulation
