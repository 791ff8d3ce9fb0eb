#include "furrow_vision/field_outcome.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "furrow_vision/evaluation.hpp"

namespace furrow::vision {
namespace {

constexpr double kMmPerPx = 2.0;

AnnotatedInstance plant(const cv::Rect& box, SubClassKind kind) {
  AnnotatedInstance instance;
  instance.kind = kind;
  instance.box_px = box;
  instance.mask = cv::Mat(box.size(), CV_8U, cv::Scalar(255));
  instance.stem_px = Eigen::Vector2d(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
  return instance;
}

Instance weed_at(double u, double v) {
  Instance instance;
  instance.stem_px = {u, v};
  instance.box_px = cv::Rect(static_cast<int>(u) - 1, static_cast<int>(v) - 1, 3, 3);
  instance.mask = cv::Mat(3, 3, CV_8U, cv::Scalar(255));
  instance.score = 1.0;
  return instance;
}

AnnotatedImage image_of(std::vector<AnnotatedInstance> plants) {
  AnnotatedImage image;
  image.width_px = 200;
  image.height_px = 100;
  image.instances = std::move(plants);
  return image;
}

TEST(FieldOutcome, CountsACropWhenAWeedStemIsInItsMaskOrItsFootprintIsOnTheStem) {
  // The crop's stem is (49.5, 49.5). A footprint of 25 mm is 12.5 px here.
  const AnnotatedImage truth = image_of({plant({20, 20, 60, 60}, SubClassKind::kCrop)});
  EXPECT_EQ(field_outcome(truth, {weed_at(25, 25)}, kMmPerPx).crops_sprayed, 1);  // mask
  EXPECT_EQ(field_outcome(truth, {weed_at(100, 50)}, kMmPerPx).crops_sprayed, 0);
  AnnotatedImage thin = image_of({plant({48, 20, 4, 60}, SubClassKind::kCrop)});
  EXPECT_EQ(field_outcome(thin, {weed_at(60, 50)}, kMmPerPx).crops_sprayed, 1);  // 10.5 px
  EXPECT_EQ(field_outcome(thin, {weed_at(63, 50)}, kMmPerPx).crops_sprayed, 0);  // 13.5 px
}

TEST(FieldOutcome, LeavesDetectionsBelowTheThresholdUnsprayed) {
  const AnnotatedImage truth = image_of({plant({20, 20, 60, 60}, SubClassKind::kCrop)});
  Instance unsure = weed_at(25, 25);
  unsure.crop_probability = 0.4;
  EXPECT_EQ(field_outcome(truth, {unsure}, kMmPerPx).crops_sprayed, 1);
  EXPECT_EQ(field_outcome(truth, {unsure}, kMmPerPx, {.weed_probability_min = 0.7}).crops_sprayed,
            0);
}

TEST(FieldOutcome, FindsWeedsWithin15MillimetresAndLeavesCutOffOnesOut) {
  AnnotatedInstance truncated = plant({150, 40, 11, 11}, SubClassKind::kWeed);
  truncated.truncated = true;
  const AnnotatedImage truth = image_of({plant({45, 45, 11, 11}, SubClassKind::kWeed),
                                         plant({100, 45, 11, 11}, SubClassKind::kWeed),
                                         plant({0, 45, 11, 11}, SubClassKind::kWeed), truncated});
  // 7 px of 2 mm are 14 mm, 8 px 16 mm.
  const FieldOutcome outcome = field_outcome(truth, {weed_at(57, 50), weed_at(113, 50)}, kMmPerPx);
  EXPECT_EQ(outcome.weeds, 2);
  EXPECT_EQ(outcome.weeds_found, 1);
  ASSERT_EQ(outcome.stem_error_mm.size(), 1u);
  EXPECT_DOUBLE_EQ(outcome.stem_error_mm[0], 14.0);
  EXPECT_DOUBLE_EQ(outcome.weeds_found_pct(), 50.0);
  EXPECT_TRUE(std::isnan(outcome.crops_sprayed_pct()));
}

TEST(FieldOutcome, CountsDetectionsOnNothingOutsideOfIgnoredRegions) {
  AnnotatedImage truth = image_of({plant({20, 20, 10, 10}, SubClassKind::kWeed)});
  AnnotatedInstance crowd = plant({100, 20, 20, 20}, SubClassKind::kWeed);
  crowd.crowd = true;
  truth.instances.push_back(crowd);
  truth.ignore_boxes = {{150, 0, 100, 100}};  // reaches beyond the image
  const FieldOutcome outcome = field_outcome(
      truth, {weed_at(25, 25), weed_at(110, 30), weed_at(170, 50), weed_at(60, 80)}, kMmPerPx);
  EXPECT_EQ(outcome.detections_on_nothing, 1);
  const double ignored_px = 50.0 * 100.0 + 24.0 * 24.0;  // the crowd with its margin
  EXPECT_DOUBLE_EQ(outcome.area_m2, (200.0 * 100.0 - ignored_px) * 4e-6);
  EXPECT_DOUBLE_EQ(outcome.false_per_m2(), 1.0 / outcome.area_m2);
}

TEST(VisionEvaluation, LeavesIgnoredRegionsOutOfAllPixelFigures) {
  AnnotatedImage truth = image_of({plant({20, 20, 10, 10}, SubClassKind::kWeed)});
  truth.ignore_boxes = {{100, 0, 100, 100}};
  const geometry::PinholeCamera camera({200, 100, 500.0, 500.0, 99.5, 49.5});
  Instance right;
  right.box_px = {20, 20, 10, 10};
  right.mask = cv::Mat(10, 10, CV_8U, cv::Scalar(255));
  right.stem_px = {24.5, 24.5};
  VisionEvaluation evaluation;
  EXPECT_DOUBLE_EQ(evaluation.add(truth, {right, weed_at(150, 50)}, camera), 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().iou_vegetation, 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().outcome.weeds_found_pct(), 100.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().outcome.false_per_m2(), 0.0);
}

TEST(VisionEvaluation, GivesIntervalsOverImages) {
  // Half of the images are right, half are wrong: the interval of the mean must hold a half and be
  // narrower with more images. All right: no width.
  const geometry::PinholeCamera camera({200, 100, 500.0, 500.0, 99.5, 49.5});
  const AnnotatedImage truth = image_of({plant({20, 20, 10, 10}, SubClassKind::kWeed)});
  Instance right;
  right.box_px = {20, 20, 10, 10};
  right.mask = cv::Mat(10, 10, CV_8U, cv::Scalar(255));
  right.stem_px = {24.5, 24.5};
  const auto width = [&](int images, bool half) {
    VisionEvaluation evaluation;
    for (int i = 0; i < images; ++i) {
      evaluation.add(truth, half && i % 2 == 0 ? std::vector<Instance>{} : std::vector{right},
                     camera);
    }
    const ScoreIntervals intervals = evaluation.intervals(1);
    if (half) {
      EXPECT_LE(intervals.weeds_found_pct.low, 50.0);
      EXPECT_GE(intervals.weeds_found_pct.high, 50.0);
      EXPECT_LE(intervals.iou_weed.low, 0.5);
      EXPECT_GE(intervals.iou_weed.high, 0.5);
    }
    return intervals.weeds_found_pct.high - intervals.weeds_found_pct.low;
  };
  EXPECT_DOUBLE_EQ(width(10, false), 0.0);
  EXPECT_GT(width(10, true), width(100, true));
  EXPECT_GT(width(100, true), 0.0);
}

}  // namespace
}  // namespace furrow::vision
