#include "furrow_vision/augmentation.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"

namespace furrow::vision {
namespace {

double lightness(const cv::Vec3b& bgr) {
  cv::Mat pixel(1, 1, CV_32FC3, cv::Scalar(bgr[0], bgr[1], bgr[2]) / 255.0);
  cv::cvtColor(pixel, pixel, cv::COLOR_BGR2Lab);
  return pixel.at<cv::Vec3f>(0, 0)[0];
}

AnnotatedImage sample() {
  AnnotatedImage image;
  image.bgr = cv::Mat(40, 60, CV_8UC3);
  Random random(3);
  for (auto& p : cv::Mat_<cv::Vec3b>(image.bgr)) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(random.integer(0, 255));
  }
  image.width_px = 60;
  image.height_px = 40;
  AnnotatedInstance plant;
  plant.box_px = {10, 12, 6, 4};
  plant.mask = cv::Mat::zeros(4, 6, CV_8U);
  plant.mask.colRange(0, 2).setTo(255);
  plant.mask.row(0).setTo(255);
  plant.stem_px = Eigen::Vector2d(11.0, 13.5);
  image.instances = {plant};
  image.vegetation = semantic_labels(image) * 255;
  image.X_FB = geometry::Pose2{};
  return image;
}

TEST(Augmentation, ShiftsLightnessByTheAmount) {
  cv::Mat bgr(1, 1, CV_8UC3, cv::Scalar(90, 120, 100));
  const double before = lightness(bgr.at<cv::Vec3b>(0, 0));
  shift_luminance(bgr, 12.0);
  EXPECT_NEAR(lightness(bgr.at<cv::Vec3b>(0, 0)), before + 12.0, 0.4);  // 8-bit steps
  shift_luminance(bgr, -500.0);
  EXPECT_LT(lightness(bgr.at<cv::Vec3b>(0, 0)), 3.0);
}

TEST(Augmentation, ScalesEachChannel) {
  cv::Mat bgr(1, 1, CV_8UC3, cv::Scalar(100, 100, 250));
  scale_channels(bgr, {1.05, 0.95, 1.05});
  EXPECT_EQ(bgr.at<cv::Vec3b>(0, 0), cv::Vec3b(105, 95, 255));
}

TEST(Augmentation, BlursWithTheBinomialKernel) {
  // The 3x3 Gaussian of the default deviation is (1 2 1)/4 in each direction.
  cv::Mat bgr = cv::Mat::zeros(3, 3, CV_8UC3);
  bgr.at<cv::Vec3b>(1, 1) = {160, 160, 160};
  blur_3x3(bgr);
  EXPECT_EQ(bgr.at<cv::Vec3b>(1, 1)[0], 40);
  EXPECT_EQ(bgr.at<cv::Vec3b>(0, 1)[0], 40);  // 20, and 20 mirrored at the border's other side
}

TEST(Augmentation, BrightensInsideTheBoxOnly) {
  cv::Mat bgr(100, 100, CV_8UC3, cv::Scalar::all(80));
  const double before = lightness({80, 80, 80});
  IlluminationBox box;
  box.box = cv::RotatedRect({50.0f, 50.0f}, {40.0f, 20.0f}, 90.0f);  // 20 wide, 40 high
  box.gain = 20.0;
  brighten_box(bgr, box);
  EXPECT_NEAR(lightness(bgr.at<cv::Vec3b>(50, 50)), before + 20.0, 0.4);
  EXPECT_NEAR(lightness(bgr.at<cv::Vec3b>(66, 50)), before + 20.0, 0.4);
  EXPECT_EQ(bgr.at<cv::Vec3b>(50, 65), cv::Vec3b(80, 80, 80));
  const double edge = lightness(bgr.at<cv::Vec3b>(50, 61));  // one beyond the filled columns 40..60
  EXPECT_GT(edge, before + 1.0);
  EXPECT_LT(edge, before + 19.0);
}

TEST(Augmentation, BoxOutsideOfTheImageChangesNothing) {
  cv::Mat bgr(10, 10, CV_8UC3, cv::Scalar::all(80));
  IlluminationBox box;
  box.box = cv::RotatedRect({500.0f, 500.0f}, {20.0f, 20.0f}, 5.0f);
  box.gain = 20.0;
  brighten_box(bgr, box);
  EXPECT_EQ(cv::countNonZero(bgr.reshape(1) != 80), 0);
}

TEST(Augmentation, FlippingTwiceIsNothing) {
  const AnnotatedImage original = sample();
  AnnotatedImage image = sample();
  AugmentationDraw draw;
  draw.flip_horizontal = true;
  draw.flip_vertical = true;
  apply_augmentation(draw, image);
  EXPECT_EQ(image.bgr.at<cv::Vec3b>(0, 0), original.bgr.at<cv::Vec3b>(39, 59));
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(60 - 16, 40 - 16, 6, 4));
  EXPECT_EQ(*image.instances[0].stem_px, Eigen::Vector2d(59 - 11.0, 39 - 13.5));
  EXPECT_FALSE(image.X_FB.has_value());
  apply_augmentation(draw, image);
  EXPECT_EQ(cv::countNonZero((image.bgr != original.bgr).operator cv::Mat().reshape(1)), 0);
  EXPECT_EQ(cv::countNonZero(semantic_labels(image) != semantic_labels(original)), 0);
}

TEST(Augmentation, TurnsMasksWithTheImage) {
  // A quarter turn about the centre (29.5, 19.5) of the image, from u to v.
  AnnotatedImage image = sample();
  AugmentationDraw draw;
  draw.rotation_rad = std::numbers::pi / 2.0;
  apply_augmentation(draw, image);
  ASSERT_EQ(image.instances.size(), 1u);
  // (u, v) goes to (29.5 - (v - 19.5), 19.5 + (u - 29.5)): columns 12..15 to 37..34.
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(34, 0, 4, 6));
  EXPECT_NEAR(image.instances[0].stem_px->x(), 49.0 - 13.5, 1e-9);
  EXPECT_NEAR(image.instances[0].stem_px->y(), 11.0 - 10.0, 1e-9);
  EXPECT_EQ(cv::countNonZero((image.vegetation > 0) != (semantic_labels(image) > 0)), 0);
}

TEST(Augmentation, DropsInstancesThatLeaveTheImage) {
  AnnotatedImage image = sample();
  AugmentationDraw draw;
  draw.scale = 8.0;
  apply_augmentation(draw, image);
  EXPECT_TRUE(image.instances.empty());
}

TEST(Augmentation, SameSeedSameBytes) {
  const Augmenter augmenter({.scale_min = 0.8, .scale_max = 1.2, .rotation_max_rad = 0.3});
  AnnotatedImage a = sample(), b = sample(), c = sample();
  Random first(5, "augmentation", 1), again(5, "augmentation", 1), other(6, "augmentation", 1);
  apply_augmentation(augmenter.draw(a.bgr.size(), first), a);
  apply_augmentation(augmenter.draw(b.bgr.size(), again), b);
  apply_augmentation(augmenter.draw(c.bgr.size(), other), c);
  EXPECT_EQ(cv::norm(a.bgr, b.bgr, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(a.bgr, c.bgr, cv::NORM_INF), 0.0);
}

TEST(Augmentation, DrawsEachTransformOnItsOwnWithItsProbability) {
  const Augmenter augmenter({});
  Random random(7);
  constexpr int kDraws = 4000;
  int luminance = 0, gains = 0, blur = 0, box = 0, both = 0;
  for (int i = 0; i < kDraws; ++i) {
    const AugmentationDraw draw = augmenter.draw({640, 480}, random);
    luminance += draw.luminance.has_value();
    gains += draw.channel_gains.has_value();
    blur += draw.blur;
    box += draw.box.has_value();
    both += draw.luminance && draw.box;
    EXPECT_LE(std::abs(draw.luminance.value_or(0.0)), 15.0);
    EXPECT_LE(std::abs(draw.box.value_or(IlluminationBox{}).box.angle), 10.0f + 1e-4f);
    if (draw.channel_gains) {
      for (const double gain : *draw.channel_gains) EXPECT_LE(std::abs(gain - 1.0), 0.05);
    }
  }
  // Five standard deviations of a binomial of 4000 halves are 158, of quarters 137.
  for (const int count : {luminance, gains, blur, box}) EXPECT_NEAR(count, kDraws / 2, 158);
  EXPECT_NEAR(both, kDraws / 4, 137);
}

TEST(Augmentation, RefusesParametersOutOfRange) {
  EXPECT_THROW(Augmenter({.probability = 1.5}), ConfigError);
  EXPECT_THROW(Augmenter({.box_edge_kernel_px = 4}), ConfigError);
  EXPECT_THROW(Augmenter({.scale_min = 2.0}), ConfigError);
}

}  // namespace
}  // namespace furrow::vision
