#include "furrow_vision/plant_context.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace furrow::vision {
namespace {

const cv::Scalar kSoil(100, 100, 100), kYellowish(60, 140, 100), kBluish(110, 130, 90),
    kStone(200, 200, 190);
const std::vector<SubClass> kClasses = {{"beet", SubClassKind::kCrop},
                                        {"thistle", SubClassKind::kWeed},
                                        {"grass", SubClassKind::kWeed}};

/// A picture of soil, at 1 mm per px, in which plants are painted.
class Scene {
 public:
  Scene() : bgr_(200, 300, CV_8UC3, kSoil), mask_(cv::Mat::zeros(200, 300, CV_8U)) {}

  /// `certainty` is that of the stem.
  void add(const cv::Rect& box, const cv::Scalar& colour, double crop_log_odds,
           double certainty = 0.3) {
    bgr_(box).setTo(colour);
    mask_(box).setTo(255);
    const double crop = 1.0 / (1.0 + std::exp(-crop_log_odds));
    Instance plant;
    plant.score = 0.9;
    plant.class_scores = {crop, 0.75 * (1.0 - crop), 0.25 * (1.0 - crop)};
    plant.stem_score = certainty;
    plant.crop_probability = crop;
    plant.box_px = box;
    plant.mask = cv::Mat(box.size(), CV_8U, cv::Scalar(255));
    plant.stem_px = {box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1)};
    plant.area_mm2 = box.area();
    plants_.push_back(plant);
  }
  ContextReport apply(const PlantContextParameters& parameters = {},
                      ColourKind colour = ColourKind::kNatural) {
    const cv::Mat no_depth;
    const RgbdView view{bgr_, no_depth, camera_};
    return apply_plant_context(view, mask_, colour, kClasses, parameters, plants_);
  }
  [[nodiscard]] const std::vector<Instance>& plants() const { return plants_; }
  cv::Mat& bgr() { return bgr_; }
  cv::Mat& mask() { return mask_; }

 private:
  cv::Mat bgr_, mask_;
  geometry::PinholeCamera camera_{{300, 200, 1000.0, 1000.0, 149.5, 99.5}};
  std::vector<Instance> plants_;
};

TEST(RelativeColours, AreDifferencesToTheSoil) {
  Scene scene;
  scene.add({20, 20, 40, 40}, kYellowish, 0.0);
  scene.bgr().setTo(cv::Scalar(80, 100, 120), scene.mask() == 0);
  const auto colours = relative_colours(scene.bgr(), scene.mask(), scene.plants());
  ASSERT_EQ(colours.size(), 1u);
  EXPECT_NEAR(colours[0].yellowness, (140.0 - 60.0) / 300.0 - (100.0 - 80.0) / 300.0, 1e-9);
  EXPECT_NEAR(colours[0].greenness, (140.0 - 100.0) / 300.0 - (100.0 - 120.0) / 300.0, 1e-9);
  scene.mask().setTo(255);
  EXPECT_TRUE(relative_colours(scene.bgr(), scene.mask(), scene.plants()).empty());
}

TEST(PlantContext, LeavesTheLearnedClassInAFamiliarImage) {
  Scene scene;
  scene.add({20, 20, 40, 40}, kYellowish, -3.0, 0.9);
  scene.add({20, 120, 10, 10}, kBluish, -6.0, 0.9);
  const auto before = scene.plants();
  const ContextReport report = scene.apply();
  EXPECT_DOUBLE_EQ(report.familiarity, 1.0);
  ASSERT_EQ(scene.plants().size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scene.plants()[i].class_scores, before[i].class_scores);
  }
}

TEST(PlantContext, TakesTheYellowerPlantForTheCropInAnUnfamiliarImage) {
  // Yellowness .267 and .067 above the soil's 0; the evidence of the first is cut at 3.
  Scene scene;
  scene.add({20, 20, 40, 40}, kYellowish, -3.0);
  scene.add({200, 120, 40, 40}, kBluish, -5.0);
  const ContextReport report = scene.apply();
  EXPECT_DOUBLE_EQ(report.familiarity, 0.0);
  ASSERT_EQ(scene.plants().size(), 2u);
  const auto probability = [](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); };
  EXPECT_NEAR(scene.plants()[0].crop_probability, probability(0.5 * (-3.0 + 4.0) + 3.0), 1e-9);
  const double yellowness = 20.0 / 330.0;
  EXPECT_NEAR(scene.plants()[1].crop_probability,
              probability(0.5 * (-5.0 + 4.0) + 50.0 * (yellowness - 0.085)), 1e-9);
  double sum = 0.0;
  for (const double score : scene.plants()[0].class_scores) sum += score;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(PlantContext, LetsTheRowDecideBetweenPlantsOfOneLook) {
  // Four clear crops in a row, and two plants of one look: one in the row, one 120 mm beside it.
  Scene scene;
  for (int k = 0; k < 4; ++k) scene.add({10 + 70 * k, 140, 30, 30}, kYellowish, 2.0);
  scene.add({250, 145, 20, 20}, kBluish, -3.0);
  scene.add({250, 20, 20, 20}, kBluish, -3.0);
  const auto at = [&](double row_evidence_max) {
    Scene copy = scene;
    copy.apply({.class_evidence = "context",
                .row_evidence_max = row_evidence_max,
                .row_sd_mm = 20.0,
                .crop_reach_mm = 0.0});
    return std::pair(copy.plants()[4].crop_probability, copy.plants()[5].crop_probability);
  };
  const auto [in_row, beside] = at(1.0);
  const auto [in_row_alone, beside_alone] = at(0.0);
  EXPECT_NEAR(in_row_alone, beside_alone, 1e-9);
  EXPECT_GT(in_row, in_row_alone + 0.1);
  EXPECT_LT(beside, beside_alone - 0.1);
}

TEST(PlantContext, LeavesColourOutInFalseColour) {
  Scene scene;
  scene.add({20, 20, 40, 40}, kYellowish, -5.0);
  scene.apply({}, ColourKind::kFalseColour);
  EXPECT_NEAR(scene.plants()[0].crop_probability, 1.0 / (1.0 + std::exp(0.5)), 1e-9);
}

TEST(PlantContext, TakesAWeedAmongACropsLeavesForAPartOfIt) {
  const PlantContextParameters context{.class_evidence = "context"};
  Scene scene;
  scene.add({20, 20, 40, 40}, kYellowish, 0.0);  // crop of 1600 mm2, columns up to 59
  scene.add({64, 36, 8, 8}, kBluish, -6.0);      // stem at 67.5: 8.5 mm from the crop
  scene.add({68, 80, 8, 8}, kBluish, -6.0);      // stem more than 20 mm away
  const ContextReport report = scene.apply(context);
  EXPECT_EQ(report.merged_into_crops, 1);
  ASSERT_EQ(scene.plants().size(), 2u);
  const Instance& crop = scene.plants()[0];
  EXPECT_EQ(crop.box_px, cv::Rect(20, 20, 52, 40));
  EXPECT_EQ(cv::countNonZero(crop.mask), 1600 + 64);
  EXPECT_NEAR(crop.area_mm2, 1664.0, 1e-6);
  EXPECT_EQ(crop.stem_px, Eigen::Vector2d(39.5, 39.5));
  EXPECT_LT(scene.plants()[1].crop_probability, 0.5);

  Scene small;  // a crop of 400 mm2 has no reach
  small.add({20, 20, 20, 20}, kYellowish, 0.0);
  small.add({44, 26, 8, 8}, kBluish, -6.0);
  EXPECT_EQ(small.apply(context).merged_into_crops, 0);
}

TEST(PlantContext, DropsWhatIsNotGreenerThanTheSoil) {
  Scene scene;
  scene.add({20, 20, 20, 20}, kStone, -6.0, 0.9);
  scene.add({120, 20, 20, 20}, kYellowish, -6.0, 0.9);
  EXPECT_EQ(scene.apply().dropped_as_not_green, 1);
  ASSERT_EQ(scene.plants().size(), 1u);
  EXPECT_EQ(scene.plants()[0].box_px.x, 120);
}

TEST(PlantContext, AsksForMoreGreenOrAStemWhereVegetationIsRare) {
  // 2 x 100 of 60000 px are rare. Greenness of the dull green: 20 / 320 = .0625.
  const cv::Scalar dull(100, 120, 100);
  Scene scene;
  scene.add({20, 20, 10, 10}, dull, -6.0, 0.1);
  scene.add({120, 20, 10, 10}, dull, -6.0, 0.9);
  EXPECT_EQ(scene.apply().dropped_as_not_green, 1);
  ASSERT_EQ(scene.plants().size(), 1u);
  EXPECT_EQ(scene.plants()[0].box_px.x, 120);
}

TEST(PlantContext, KeepsAllPlantsWhereNoSoilIsSeen) {
  Scene scene;
  scene.add({0, 0, 300, 200}, kStone, 2.0, 0.9);
  EXPECT_EQ(scene.apply().dropped_as_not_green, 0);
  EXPECT_EQ(scene.plants().size(), 1u);
}

TEST(PlantContext, AcceptsAnImageWithoutPlants) {
  Scene scene;
  const ContextReport report = scene.apply();
  EXPECT_DOUBLE_EQ(report.familiarity, 1.0);
  EXPECT_TRUE(scene.plants().empty());
}

}  // namespace
}  // namespace furrow::vision
