#include "furrow_vision/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "furrow_vision/evaluation.hpp"

namespace furrow::vision {
namespace {

AnnotatedInstance truth(const cv::Rect& box, SubClassKind kind = SubClassKind::kWeed) {
  AnnotatedInstance instance;
  instance.kind = kind;
  instance.box_px = box;
  instance.mask = cv::Mat(box.size(), CV_8U, cv::Scalar(255));
  return instance;
}

Instance found(const cv::Rect& box, double score, double crop_probability = 0.0) {
  Instance instance;
  instance.score = score;
  instance.crop_probability = crop_probability;
  instance.class_scores = {crop_probability, 1.0 - crop_probability};
  instance.box_px = box;
  instance.mask = cv::Mat(box.size(), CV_8U, cv::Scalar(255));
  return instance;
}

TEST(Overlap, OfBoxesAndMasks) {
  const cv::Rect a(0, 0, 10, 10), b(5, 0, 10, 10);
  EXPECT_DOUBLE_EQ(box_iou(a, b), 50.0 / 150.0);
  cv::Mat left = cv::Mat::zeros(10, 10, CV_8U);
  left.colRange(0, 5).setTo(255);  // pixels 0..4 of a: none of b
  const cv::Mat full(10, 10, CV_8U, cv::Scalar(255));
  EXPECT_DOUBLE_EQ(mask_iou(a, left, b, full), 0.0);
  EXPECT_DOUBLE_EQ(mask_iou(a, full, b, left), 50.0 / 100.0);
  EXPECT_DOUBLE_EQ(box_iou(a, {}), 0.0);
}

TEST(AveragePrecision, OfAHandMadeCase) {
  // Four truths. In the order of scores: right, wrong, right, wrong, right; the fourth is missed.
  // Recall after each: 1/4, 1/4, 2/4, 2/4, 3/4; precision 1, 1/2, 2/3, 1/2, 3/5. Made monotone:
  // 1 up to recall .25, 2/3 up to .5, 3/5 up to .75, then 0. Of the points 0, .01, ..., 1 these
  // are 26, 25 and 25.
  const double expected = (26 * 1.0 + 25 * (2.0 / 3.0) + 25 * (3.0 / 5.0)) / 101.0;
  const std::vector<AnnotatedInstance> truths = {truth({0, 0, 10, 10}), truth({20, 0, 10, 10}),
                                                 truth({40, 0, 10, 10}), truth({60, 0, 10, 10})};
  const std::vector<Instance> detections = {
      found({40, 0, 10, 10}, 0.5), found({0, 50, 10, 10}, 0.8), found({0, 0, 10, 10}, 0.9),
      found({50, 50, 10, 10}, 0.6), found({20, 0, 10, 10}, 0.7)};
  for (const Overlap overlap : {Overlap::kBox, Overlap::kMask}) {
    AveragePrecision ap(overlap, ClassMode::kAny);
    ap.add(truths, detections);
    EXPECT_NEAR(ap.scores().ap50, expected, 1e-12);
    EXPECT_NEAR(ap.scores().ap, expected, 1e-12);  // exact boxes match at every threshold
  }
}

TEST(AveragePrecision, CountsAThresholdOnlyWhereTheOverlapReachesIt) {
  // IoU 8/10: matched at .50, .55, ..., .80, seven of ten thresholds.
  AveragePrecision ap(Overlap::kBox, ClassMode::kAny);
  ap.add({truth({0, 0, 10, 10})}, {found({0, 0, 10, 8}, 0.9)});
  EXPECT_NEAR(ap.scores().ap50, 1.0, 1e-12);
  EXPECT_NEAR(ap.scores().ap, 0.7, 1e-12);
}

TEST(AveragePrecision, AllowsATruthOneDetectionAndIgnoresCrowds) {
  // The second detection of the same truth is wrong, but comes after full recall.
  AveragePrecision twice(Overlap::kBox, ClassMode::kAny);
  twice.add({truth({0, 0, 10, 10})}, {found({0, 0, 10, 10}, 0.9), found({0, 0, 10, 10}, 0.95)});
  EXPECT_NEAR(twice.scores().ap50, 1.0, 1e-12);
  // Before it, a detection inside a crowd region counts neither way.
  AnnotatedInstance crowd = truth({100, 100, 50, 50});
  crowd.crowd = true;
  AveragePrecision crowded(Overlap::kMask, ClassMode::kAny);
  crowded.add({crowd, truth({0, 0, 10, 10})},
              {found({110, 110, 10, 10}, 0.95), found({0, 0, 10, 10}, 0.9)});
  EXPECT_NEAR(crowded.scores().ap50, 1.0, 1e-12);
}

TEST(AveragePrecision, TellsClasses) {
  AveragePrecision ap(Overlap::kBox, ClassMode::kCropWeed);
  ap.add({truth({0, 0, 10, 10}, SubClassKind::kCrop), truth({20, 0, 10, 10})},
         {found({0, 0, 10, 10}, 0.9, 0.8), found({20, 0, 10, 10}, 0.9, 0.8)});
  const auto scores = ap.scores();
  // Both are called crops with equal scores; the first, right, comes first.
  EXPECT_NEAR(scores.ap50_crop, 1.0, 1e-12);
  EXPECT_NEAR(scores.ap50_weed, 0.0, 1e-12);
  EXPECT_NEAR(scores.ap50, 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(AveragePrecision(Overlap::kBox, ClassMode::kAny).scores().ap));
}

TEST(PanopticQuality, OfAHandMadeCase) {
  // One match of IoU .8, one truth missed, one detection wrong: .8 / (1 + .5 + .5).
  PanopticQuality pq(ClassMode::kAny);
  pq.add({truth({0, 0, 10, 10}), truth({50, 0, 10, 10})},
         {found({0, 0, 10, 8}, 0.9), found({50, 8, 10, 10}, 0.9)});
  EXPECT_NEAR(pq.value(), 0.4, 1e-12);
  EXPECT_TRUE(std::isnan(PanopticQuality(ClassMode::kAny).value()));
}

TEST(SemanticScore, SumsPixelsOverImages) {
  cv::Mat actual = cv::Mat::zeros(1, 4, CV_8U), predicted = cv::Mat::zeros(1, 4, CV_8U);
  actual.at<std::uint8_t>(0, 0) = 1;
  actual.at<std::uint8_t>(0, 1) = 2;
  predicted.at<std::uint8_t>(0, 0) = 1;
  predicted.at<std::uint8_t>(0, 1) = 1;
  SemanticScore score;
  score.add(actual, predicted);
  score.add_vegetation(actual, predicted);
  EXPECT_DOUBLE_EQ(score.weed().iou(), 0.5);
  EXPECT_DOUBLE_EQ(score.crop().iou(), 0.0);
  EXPECT_DOUBLE_EQ(score.soil().iou(), 1.0);
  EXPECT_DOUBLE_EQ(score.mean_iou(), 0.5);
  EXPECT_DOUBLE_EQ(score.vegetation().iou(), 1.0);
}

TEST(MeasureErrors, OfStemsAndAreas) {
  const geometry::PinholeCamera camera({100, 100, 100.0, 100.0, 49.5, 49.5});
  AnnotatedInstance actual = truth({0, 0, 10, 10});
  actual.stem_px = Eigen::Vector2d(5.0, 5.0);
  Instance detection = found({0, 0, 10, 10}, 0.9);
  detection.stem_px = {8.0, 9.0};  // 3 and 4 pixels of 20 mm at 2 m
  detection.stem_depth_m = 2.0;
  detection.area_mm2 = 90.0;
  MeasureErrors errors;
  add_measure_errors({actual}, {100.0}, {detection}, camera, 0.5, errors);
  ASSERT_EQ(errors.stem_mm.size(), 1u);
  EXPECT_NEAR(errors.stem_mm[0], 100.0, 1e-9);
  ASSERT_EQ(errors.area_relative.size(), 1u);
  EXPECT_NEAR(errors.area_relative[0], 0.1, 1e-12);
}

TEST(VisionEvaluation, LeavesVegetationWithoutAClassOutOfTheClasses) {
  const auto square = [](int u) {
    AnnotatedInstance plant;
    plant.box_px = {u, 10, 10, 10};
    plant.mask = cv::Mat(10, 10, CV_8U, cv::Scalar(255));
    return plant;
  };
  AnnotatedImage truth;
  truth.width_px = 80;
  truth.height_px = 40;
  truth.instances = {square(10)};
  truth.vegetation = cv::Mat::zeros(40, 80, CV_8U);
  for (const int u : {10, 30, 50}) truth.vegetation(cv::Rect(u, 10, 10, 10)) = 1;
  std::vector<Instance> found;
  for (const int u : {10, 30, 50}) {
    found.push_back(
        {.score = 1.0, .box_px = {u, 10, 10, 10}, .mask = cv::Mat(10, 10, CV_8U, cv::Scalar(255))});
  }
  const geometry::PinholeCamera camera({80, 40, 100.0, 100.0, 39.5, 19.5});
  VisionEvaluation evaluation;
  EXPECT_DOUBLE_EQ(evaluation.add(truth, found, camera), 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().iou_weed, 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().iou_vegetation, 1.0);
  found.pop_back();
  evaluation.add(truth, found, camera);
  EXPECT_DOUBLE_EQ(evaluation.scores().iou_weed, 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().iou_vegetation, 500.0 / 600.0);
}

}  // namespace
}  // namespace furrow::vision
