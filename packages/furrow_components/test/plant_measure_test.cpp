/// Area and growth stage of rendered plants, measured from an image, against the ground truth.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "furrow_core/statistics.hpp"
#include "furrow_simulation/renderer.hpp"
#include "furrow_vision/detector.hpp"
#include "furrow_vision/growth_stage.hpp"

namespace furrow::vision {
namespace {

struct Measured {
  double truth_mm2 = 0.0;
  double by_depth_mm2 = 0.0;
  double as_on_level_ground_mm2 = 0.0;
  double ground_m = 0.0;
};

/// Plants of several species and sizes in a row, each seen by a low camera over the most
/// uneven ground of the renderer.
class PlantsOnUnevenGround : public testing::Test {
 protected:
  static constexpr double kHeight_m = 0.6;

  void SetUp() override {
    field::FieldModel field{.name = "test", .source = "test", .length_m = 8.0, .width_m = 2.0};
    struct Kind {
      const char* species;
      double radius_m;
      double area_mm2;
      int leaves;
    };
    const Kind kinds[] = {{"sugar_beet", 0.05, 4500.0, 6},    {"sugar_beet", 0.025, 900.0, 2},
                          {"lambsquarters", 0.03, 1300.0, 4}, {"thistle", 0.04, 2200.0, 6},
                          {"chickweed", 0.02, 500.0, 4},      {"pigweed", 0.012, 180.0, 2}};
    constexpr int kPlants = 18;
    for (int i = 0; i < kPlants; ++i) {
      const Kind& kind = kinds[i % std::size(kinds)];
      field::Plant plant;
      plant.id = i + 1;
      plant.kind = i % std::size(kinds) < 2 ? field::PlantKind::kCrop : field::PlantKind::kWeed;
      plant.species = kind.species;
      plant.p_F_m = {1.0 + 0.35 * i, 0.1 * (i % 3 - 1)};
      plant.radius_m = kind.radius_m;
      plant.area_mm2 = kind.area_mm2;
      plant.leaves = kind.leaves;
      field.plants.push_back(plant);
    }
    simulation::RendererParameters look;
    look.camera = simulation::CameraEffectParameters::none();
    look.ground.undulation_mm = 40.0;
    simulation::Renderer renderer(field, look, 3);
    for (std::size_t i = 0; i < field.plants.size(); ++i) measure(renderer, i);
  }

  void measure(simulation::Renderer& renderer, std::size_t index) {
    const Eigen::Vector2d at = renderer.field().plants[index].p_F_m;
    Eigen::Isometry3d X_FC = Eigen::Isometry3d::Identity();
    X_FC.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
    X_FC.translation() = Eigen::Vector3d(at.x() + 0.03, at.y() - 0.02, kHeight_m);
    const simulation::Frame frame = renderer.render(camera_, X_FC, 0);
    const auto visible =
        std::find_if(frame.plants.begin(), frame.plants.end(),
                     [&](const auto& plant) { return plant.plant_index == index; });
    ASSERT_NE(visible, frame.plants.end());
    const cv::Mat whole = frame.plant_index == static_cast<int>(index);
    Instance plant;
    plant.box_px = cv::boundingRect(whole);
    plant.mask = whole(plant.box_px);
    plant.stem_px = visible->stem_px;
    Instance level = plant;
    measure_instance({frame.bgr, frame.depth_m, camera_, kHeight_m}, plant);
    measure_instance({frame.bgr, cv::Mat(), camera_, kHeight_m}, level);
    ASSERT_FALSE(plant.touches_border);
    EXPECT_TRUE(plant.depth_measured);
    EXPECT_FALSE(level.depth_measured);
    measured_.push_back({visible->area_mm2, plant.area_mm2, level.area_mm2,
                         renderer.ground_height_m(at.x(), at.y())});
  }

  geometry::PinholeCamera camera_{{320, 240, 520.0, 520.0, 159.5, 119.5}};
  std::vector<Measured> measured_;
};

TEST_F(PlantsOnUnevenGround, AreaMeasuredWithDepthIsThatOfThePlant) {
  std::vector<double> by_depth, level;
  const auto [low, high] =
      std::minmax_element(measured_.begin(), measured_.end(),
                          [](const auto& a, const auto& b) { return a.ground_m < b.ground_m; });
  // The height must vary for the test to be meaningful: 3 cm of 60 cm are 10 % of an area.
  ASSERT_GT(high->ground_m - low->ground_m, 0.03);
  for (const Measured& plant : measured_) {
    by_depth.push_back(std::abs(plant.by_depth_mm2 / plant.truth_mm2 - 1.0));
    level.push_back(std::abs(plant.as_on_level_ground_mm2 / plant.truth_mm2 - 1.0));
    EXPECT_LT(by_depth.back(), 0.06) << plant.truth_mm2 << " at " << plant.ground_m;
  }
  EXPECT_LT(median(by_depth), 0.02);
  EXPECT_GT(*std::max_element(level.begin(), level.end()),
            2.0 * *std::max_element(by_depth.begin(), by_depth.end()));
}

TEST_F(PlantsOnUnevenGround, GrowthStageFollowsTheTrueArea) {
  const GrowthStageEstimator estimator({});
  for (const Measured& plant : measured_) {
    EXPECT_EQ(estimator.stage(plant.by_depth_mm2), estimator.stage(plant.truth_mm2))
        << plant.truth_mm2;
  }
}

}  // namespace
}  // namespace furrow::vision
