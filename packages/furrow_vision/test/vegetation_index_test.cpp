#include "furrow_vision/vegetation_index.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "furrow_core/random.hpp"

namespace furrow::vision {
namespace {

cv::Mat noisy_soil(cv::Size size, std::uint64_t seed, double sd, cv::Vec3b colour = {70, 90, 110}) {
  Random random(seed);
  cv::Mat bgr(size, CV_8UC3);
  for (auto& pixel : cv::Mat_<cv::Vec3b>(bgr)) {
    const double light = random.normal(0.0, 12.0);
    for (int c = 0; c < 3; ++c) {
      pixel[c] = cv::saturate_cast<std::uint8_t>(colour[c] + light + random.normal(0.0, sd));
    }
  }
  return bgr;
}

double iou(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

TEST(VegetationIndex, EqualsExcessGreenAtMediumBrightness) {
  // R + G + B = 330: 2G - R - B = 3G - 330, at any softening.
  const cv::Mat bgr(1, 1, CV_8UC3, cv::Scalar(80, 140, 110));
  for (const double softening : {0.0, 300.0, 1e5}) {
    EXPECT_EQ(vegetation_index(bgr, softening).index.at<std::uint8_t>(0, 0), kIndexZero + 90);
  }
}

TEST(VegetationIndex, WithoutSofteningDoesNotDependOnTheLight) {
  const cv::Mat bright(1, 1, CV_8UC3, cv::Scalar(60, 160, 120));
  const cv::Mat dark(1, 1, CV_8UC3, cv::Scalar(15, 40, 30));
  EXPECT_EQ(vegetation_index(bright, 0.0).index.at<std::uint8_t>(0, 0),
            vegetation_index(dark, 0.0).index.at<std::uint8_t>(0, 0));
}

TEST(VegetationIndex, CutsToEightBitsAndCountsEachPixel) {
  cv::Mat bgr(1, 3, CV_8UC3, cv::Scalar(0, 0, 0));
  bgr.at<cv::Vec3b>(0, 1) = {0, 255, 0};
  bgr.at<cv::Vec3b>(0, 2) = {255, 0, 255};
  const IndexImage image = vegetation_index(bgr, 0.0);
  EXPECT_EQ(image.index.at<std::uint8_t>(0, 0), kIndexZero);
  EXPECT_EQ(image.index.at<std::uint8_t>(0, 1), 255);
  EXPECT_EQ(image.index.at<std::uint8_t>(0, 2), 0);
  EXPECT_EQ(image.histogram[kIndexZero], 1u);
  EXPECT_EQ(image.histogram[255], 1u);
  EXPECT_EQ(image.histogram[0], 1u);
}

TEST(SegmentVegetation, FindsAPlantOnNoisySoilBrightAndDark) {
  for (const double light : {1.0, 0.4}) {
    cv::Mat bgr = noisy_soil({320, 240}, 1, 4.0);
    cv::Mat truth = cv::Mat::zeros(bgr.size(), CV_8U);
    cv::circle(truth, {150, 120}, 20, 255, -1);
    bgr.setTo(cv::Scalar(50, 140, 80), truth);
    bgr *= light;
    const Vegetation vegetation = segment_vegetation(bgr, {});
    ASSERT_TRUE(vegetation.found);
    EXPECT_GT(iou(vegetation.mask, truth), 0.9) << light;
  }
}

TEST(SegmentVegetation, FindsOnePlantOfAThousandthOfTheImage) {
  cv::Mat bgr = noisy_soil({640, 480}, 2, 4.0);
  cv::Mat truth = cv::Mat::zeros(bgr.size(), CV_8U);
  cv::circle(truth, {333, 222}, 10, 255, -1);
  bgr.setTo(cv::Scalar(50, 140, 80), truth);
  const Vegetation vegetation = segment_vegetation(bgr, {});
  ASSERT_TRUE(vegetation.found);
  EXPECT_GT(iou(vegetation.mask, truth), 0.7);
}

TEST(SegmentVegetation, FindsNothingOnSoil) {
  for (const cv::Vec3b& colour : {cv::Vec3b{70, 90, 110}, cv::Vec3b{90, 90, 90},
                                  cv::Vec3b{20, 25, 30}, cv::Vec3b{180, 190, 200}}) {
    for (const double sd : {0.0, 2.0, 5.0}) {
      EXPECT_FALSE(segment_vegetation(noisy_soil({320, 240}, 3, sd, colour), {}).found)
          << cv::Mat(colour).t() << " " << sd;
    }
  }
  EXPECT_FALSE(segment_vegetation(cv::Mat::zeros(40, 40, CV_8UC3), {}).found);
}

TEST(SegmentVegetation, TellsFalseColour) {
  cv::Mat bgr(240, 320, CV_8UC3);
  Random random(4);
  for (auto& pixel : cv::Mat_<cv::Vec3b>(bgr)) {
    const auto red = cv::saturate_cast<std::uint8_t>(random.normal(90.0, 8.0));
    pixel = {red, static_cast<std::uint8_t>(red + 6), red};
  }
  cv::Mat truth = cv::Mat::zeros(bgr.size(), CV_8U);
  cv::circle(truth, {100, 100}, 25, 255, -1);
  bgr.setTo(cv::Scalar(60, 180, 60), truth);
  const Vegetation vegetation = segment_vegetation(bgr, {});
  EXPECT_EQ(vegetation.colour, ColourKind::kFalseColour);
  EXPECT_GT(iou(vegetation.mask, truth), 0.9);
  EXPECT_EQ(detect_colour_kind(noisy_soil({64, 64}, 5, 4.0)), ColourKind::kNatural);
  EXPECT_EQ(detect_colour_kind(cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(80))),
            ColourKind::kNatural);
}

}  // namespace
}  // namespace furrow::vision
