#include "furrow_vision/detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"
#include "furrow_vision/index_detector.hpp"

namespace furrow::vision {
namespace {

constexpr float kHole = 0.0f;

geometry::PinholeCamera camera_of(int width, int height, double focal_px = 435.0) {
  return geometry::PinholeCamera(
      {width, height, focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0});
}

cv::Mat soil(int width = 640, int height = 480) {
  Random random(11);
  cv::Mat bgr(height, width, CV_8UC3);
  for (auto& pixel : cv::Mat_<cv::Vec3b>(bgr)) {
    const double light = random.normal(0.0, 8.0);
    pixel = {cv::saturate_cast<std::uint8_t>(70 + light + random.normal(0.0, 3.0)),
             cv::saturate_cast<std::uint8_t>(88 + light + random.normal(0.0, 3.0)),
             cv::saturate_cast<std::uint8_t>(105 + light + random.normal(0.0, 3.0))};
  }
  return bgr;
}

/// Leaves around a stem, as ellipses; a plant with two leaves leaves the stem itself bare.
void draw_plant(cv::Mat& bgr, cv::Point2d stem, double leaf_px, int leaves, double heading) {
  if (leaves > 2) cv::circle(bgr, stem, cvRound(0.35 * leaf_px), cv::Scalar(50, 140, 80), -1);
  for (int i = 0; i < leaves; ++i) {
    const double angle = heading + 2.0 * std::numbers::pi * i / leaves;
    const cv::Point centre(
        static_cast<int>(std::lround(stem.x + 0.75 * leaf_px * std::cos(angle))),
        static_cast<int>(std::lround(stem.y + 0.75 * leaf_px * std::sin(angle))));
    cv::ellipse(bgr, centre, {cvRound(0.6 * leaf_px), cvRound(0.3 * leaf_px)},
                angle * 180.0 / std::numbers::pi, 0.0, 360.0, cv::Scalar(50, 140, 80), -1);
  }
}

TEST(CheckView, SaysWhatIsWrong) {
  const auto camera = camera_of(32, 24);
  const cv::Mat good(24, 32, CV_8UC3, cv::Scalar::all(80)), none;
  const auto error = [&](const cv::Mat& bgr, const cv::Mat& depth, double ground = 1.0) {
    const Status status = check_view({bgr, depth, camera, ground});
    return status.ok() ? std::string() : status.error().message;
  };
  EXPECT_EQ(error(good, none), "");
  EXPECT_EQ(error(good, cv::Mat(24, 32, CV_32F, cv::Scalar(1.0))), "");
  EXPECT_NE(error(none, none).find("empty"), std::string::npos);
  EXPECT_NE(error(cv::Mat(24, 32, CV_8U), none).find("not 1 of 8 bits"), std::string::npos);
  EXPECT_NE(error(cv::Mat(24, 32, CV_16UC3), none).find("not 3 of 16 bits"), std::string::npos);
  EXPECT_NE(error(cv::Mat(23, 32, CV_8UC3), none).find("32x23"), std::string::npos);
  EXPECT_NE(error(good, cv::Mat(12, 16, CV_32F)).find("depth is 16x12"), std::string::npos);
  EXPECT_NE(error(good, cv::Mat(24, 32, CV_16U)).find("32-bit floats"), std::string::npos);
  EXPECT_NE(error(good, none, -1.0).find("ground distance"), std::string::npos);
  EXPECT_NE(error(good, none, std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(CheckView, BoundsTheSize) {
  // One row of memory seen 20000 times over: huge to read, small to hold.
  static std::array<std::uint8_t, 3 * 16> row{};
  const cv::Mat huge(20000, 16, CV_8UC3, row.data(), 0);
  const auto camera = camera_of(16, 20000);
  const cv::Mat none;
  const Status status = check_view({huge, none, camera});
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("larger than allowed"), std::string::npos);
}

TEST(ShiftTowardsCrops, ChangesTheOddsByTheFactor) {
  const std::vector<SubClass> classes = {{"beet", SubClassKind::kCrop},
                                         {"goosefoot", SubClassKind::kWeed},
                                         {"grass", SubClassKind::kWeed}};
  std::vector<double> scores = {0.2, 0.6, 0.2};
  shift_towards_crops(std::log(4.0), classes, scores);  // odds 1 : 4 become 1 : 1
  EXPECT_NEAR(scores[0], 0.5, 1e-12);
  EXPECT_NEAR(scores[1], 0.375, 1e-12);
  EXPECT_NEAR(scores[2], 0.125, 1e-12);
}

class MeasureInstance : public testing::Test {
 protected:
  MeasureInstance() {
    instance_.box_px = {10, 10, 10, 10};
    instance_.mask = cv::Mat(10, 10, CV_8U, cv::Scalar(255));
    instance_.stem_px = {14.5, 14.5};
  }
  void measure(const cv::Mat& depth) { measure_instance({bgr_, depth, camera_, 2.0}, instance_); }

  // 100 px: a pixel covers 10 mm at 1 m, 100 mm2; 400 mm2 at 2 m.
  geometry::PinholeCamera camera_ = camera_of(40, 30, 100.0);
  cv::Mat bgr_ = cv::Mat(30, 40, CV_8UC3, cv::Scalar::all(80));
  Instance instance_;
};

TEST_F(MeasureInstance, UsesTheGroundWithoutDepth) {
  measure({});
  EXPECT_FALSE(instance_.depth_measured);
  EXPECT_NEAR(instance_.area_mm2, 100 * 400.0, 1e-6);
  EXPECT_NEAR(instance_.stem_depth_m, 2.0, 1e-12);
  EXPECT_NEAR(instance_.radius_m, std::hypot(4.5, 4.5) * 2.0 / 100.0, 1e-12);
  EXPECT_FALSE(instance_.touches_border);
}

TEST_F(MeasureInstance, SumsThePixelsAtTheirDepth) {
  cv::Mat depth(30, 40, CV_32F, cv::Scalar(1.0));
  depth.colRange(0, 15).setTo(2.0);  // half of the mask
  measure(depth);
  EXPECT_TRUE(instance_.depth_measured);
  EXPECT_NEAR(instance_.area_mm2, 50 * 400.0 + 50 * 100.0, 1e-3);
}

TEST_F(MeasureInstance, FillsHolesWithTheMedian) {
  cv::Mat depth(30, 40, CV_32F, cv::Scalar(1.0));
  depth.row(10).setTo(kHole);
  depth.row(11).setTo(std::numeric_limits<float>::quiet_NaN());
  depth.row(12).setTo(-1.0f);
  depth.row(13).setTo(std::numeric_limits<float>::infinity());
  measure(depth);
  EXPECT_TRUE(instance_.depth_measured);
  EXPECT_NEAR(instance_.area_mm2, 100 * 100.0, 1e-3);
  EXPECT_NEAR(instance_.stem_depth_m, 1.0, 1e-6);
}

TEST_F(MeasureInstance, FallsBackWhereHolesLeaveTooLittle) {
  cv::Mat depth(30, 40, CV_32F, cv::Scalar(kHole));
  depth(cv::Rect(10, 10, 9, 1)).setTo(1.0);  // 9 of 100 pixels
  measure(depth);
  EXPECT_FALSE(instance_.depth_measured);
  EXPECT_NEAR(instance_.area_mm2, 100 * 400.0, 1e-6);
}

TEST(IndexDetector, FindsPlantsTheirStemsAreasAndClasses) {
  // 435 px at 1 m: 2.3 mm a pixel. Rows 0.5 m apart are 217.5 px apart: crops at 103, 320.5, 538.
  cv::Mat bgr = soil();
  std::vector<cv::Point2d> crops, weeds;
  for (const double u : {103.0, 320.5, 538.0}) {
    for (const double v : {80.0, 240.0, 400.0}) crops.emplace_back(u, v);
  }
  weeds = {{210.0, 100.0}, {200.0, 330.0}, {430.0, 200.0}, {440.0, 420.0}, {30.0, 200.0}};
  double angle = 0.1;
  for (const auto& p : crops) draw_plant(bgr, p, 28.0, 4, angle += 0.3);
  for (const auto& p : weeds) draw_plant(bgr, p, 9.0, 2, angle += 0.4);
  const auto camera = camera_of(640, 480);
  IndexDetector detector({});
  const cv::Mat none;
  const auto result = detector.detect({bgr, none, camera});
  ASSERT_TRUE(result.ok()) << result.error().message;
  ASSERT_EQ(result->size(), crops.size() + weeds.size());
  const auto check = [&](const std::vector<cv::Point2d>& stems, bool crop) {
    for (const auto& stem : stems) {
      double nearest = 1e9;
      const Instance* plant = nullptr;
      for (const Instance& i : *result) {
        const double distance = std::hypot(i.stem_px.x() - stem.x, i.stem_px.y() - stem.y);
        if (distance < nearest) {
          nearest = distance;
          plant = &i;
        }
      }
      EXPECT_LT(nearest, 2.0) << stem;
      EXPECT_EQ(plant->crop_probability > 0.5, crop) << stem << " " << plant->area_mm2;
      EXPECT_NEAR(plant->class_scores[0] + plant->class_scores[1], 1.0, 1e-12);
      EXPECT_EQ(plant->mask.size(), plant->box_px.size());
      EXPECT_NEAR(plant->area_mm2, cv::countNonZero(plant->mask) * camera.pixel_area_mm2(1.0),
                  1e-6);
    }
  };
  check(crops, true);
  check(weeds, false);
  ASSERT_FALSE(detector.crop_row_u_px().empty());
  double nearest = 1e9;
  for (const double u : detector.crop_row_u_px()) nearest = std::min(nearest, std::abs(u - 320.5));
  EXPECT_LT(nearest, 5.0);
  detector.reset();
  EXPECT_TRUE(detector.crop_row_u_px().empty());
}

TEST(IndexDetector, SplitsTwoPlantsThatTouch) {
  cv::Mat bgr = soil();
  cv::circle(bgr, {300, 240}, 20, cv::Scalar(50, 140, 80), -1);
  cv::circle(bgr, {350, 240}, 20, cv::Scalar(50, 140, 80), -1);
  cv::line(bgr, {300, 240}, {350, 240}, cv::Scalar(50, 140, 80), 3);
  const auto camera = camera_of(640, 480);
  const cv::Mat none;
  const auto result = IndexDetector({}).detect({bgr, none, camera});
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->size(), 2u);
  EXPECT_NEAR(std::abs(result->at(0).stem_px.x() - result->at(1).stem_px.x()), 50.0, 4.0);
}

TEST(IndexDetector, PlacesTheStemOnTheGroundUnderARaisedCanopy) {
  // A canopy 0.1 m above the ground at 1 m is seen at 0.9 m: what stands at 0.4 m to the right of
  // the axis appears at 0.4 / 0.9 * 435 = 193.3 px from the centre, its foot at 174 px.
  cv::Mat bgr = soil();
  cv::Mat depth(bgr.size(), CV_32F, cv::Scalar(1.0));
  const cv::Point canopy(513, 240);  // 319.5 + 193.3
  cv::circle(bgr, canopy, 18, cv::Scalar(50, 140, 80), -1);
  cv::circle(depth, canopy, 18, cv::Scalar(0.9), -1);
  const auto result = IndexDetector({}).detect({bgr, depth, camera_of(640, 480)});
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->size(), 1u);
  EXPECT_NEAR(result->at(0).stem_px.x(), 319.5 + 174.0, 1.0);
  EXPECT_NEAR(result->at(0).stem_depth_m, 1.0, 1e-6);
}

TEST(IndexDetector, TakesTheRowsThatItIsGiven) {
  cv::Mat bgr = soil();
  draw_plant(bgr, {200.0, 240.0}, 22.0, 4, 0.2);
  const auto camera = camera_of(640, 480);
  const cv::Mat none;
  IndexDetector detector({});
  const auto on = detector.detect({bgr, none, camera, 1.0, {200.0}});
  const auto off = detector.detect({bgr, none, camera, 1.0, {320.0}});
  ASSERT_TRUE(on.ok() && off.ok());
  ASSERT_EQ(on->size(), 1u);
  EXPECT_GT(on->at(0).crop_probability, 0.5);
  EXPECT_LT(off->at(0).crop_probability, 0.5);
}

TEST(IndexDetector, FindsNothingOnSoilAndTinyImages) {
  const cv::Mat none;
  IndexDetector detector({});
  const auto bare = detector.detect({soil(), none, camera_of(640, 480)});
  ASSERT_TRUE(bare.ok());
  EXPECT_TRUE(bare->empty());
  for (const int side : {1, 2, 5, 17}) {
    const cv::Mat tiny(side, side, CV_8UC3, cv::Scalar(50, 140, 80));
    EXPECT_TRUE(detector.detect({tiny, none, camera_of(side, side)}).ok());
  }
}

TEST(IndexDetector, SurvivesNoise) {
  Random random(2);
  cv::Mat bgr(240, 320, CV_8UC3);
  for (auto& p : cv::Mat_<cv::Vec3b>(bgr)) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(random.integer(0, 255));
  }
  const cv::Mat none;
  const auto result = IndexDetector({}).detect({bgr, none, camera_of(320, 240)});
  ASSERT_TRUE(result.ok());
  EXPECT_LE(result->size(), static_cast<std::size_t>(IndexDetector::kMaxPlants));
  for (const Instance& i : *result) {
    EXPECT_EQ(i.box_px & cv::Rect(0, 0, 320, 240), i.box_px);
    EXPECT_TRUE(std::isfinite(i.stem_px.x()) && std::isfinite(i.area_mm2));
  }
}

TEST(IndexDetector, RefusesGreyImagesAndParametersOutOfRange) {
  const cv::Mat grey(48, 64, CV_8U, cv::Scalar(80)), none;
  const auto camera = camera_of(64, 48);
  IndexDetector detector({});
  const auto result = detector.detect({grey, none, camera});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THROW(IndexDetector({.row_spacing_m = -1.0}), ConfigError);
  IndexDetectorParameters colour;
  colour.vegetation.colour = "infrared";
  EXPECT_THROW(IndexDetector{colour}, ConfigError);
}

}  // namespace
}  // namespace furrow::vision
