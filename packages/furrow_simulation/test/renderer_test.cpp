#include "furrow_simulation/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "furrow_core/error.hpp"
#include "scene_fixture.hpp"

namespace furrow::simulation {
namespace {

RendererParameters clean(double undulation_mm = 6.0) {
  RendererParameters p;
  p.camera = CameraEffectParameters::none();
  p.ground.undulation_mm = undulation_mm;
  p.ground.ground_resolution_mm = 4.0;
  p.ground.crumb_cover = 0.1;
  p.ground.straw_per_m2 = 1.0;
  return p;
}

std::vector<field::Plant> some_plants() {
  return {plant(1, "sugar_beet", 1.0, 0.0, 0.07, 8000, 6),
          plant(2, "lambsquarters", 1.2, 0.3, 0.03, 1200, 4),
          plant(3, "barnyardgrass", 0.8, -0.25, 0.05, 1500, 4),
          plant(4, "unheard_of", 0.75, 0.35, 0.03, 1200, 6),
          plant(5, "sugar_beet", 3.5, 0.0, 0.07, 8000, 6)};
}

TEST(Renderer, StemsProjectToThePlants) {
  Renderer renderer(field_of(some_plants()), clean(), 1);
  const auto camera = small_camera();
  const Eigen::Isometry3d X_FC = looking_down(1.0, 0.0, 1.0);
  const Frame frame = renderer.render(camera, X_FC, 0);
  ASSERT_EQ(frame.plants.size(), 4u);
  for (const VisiblePlant& visible : frame.plants) {
    const field::Plant& plant = renderer.field().plants[visible.plant_index];
    EXPECT_EQ(visible.id, plant.id);
    const double ground = renderer.ground_height_m(plant.p_F_m.x(), plant.p_F_m.y());
    const Eigen::Vector3d p_F = X_FC * camera.unproject(visible.stem_px, 1.0 - ground);
    EXPECT_NEAR(p_F.x(), plant.p_F_m.x(), 1e-5);
    EXPECT_NEAR(p_F.y(), plant.p_F_m.y(), 1e-5);
    EXPECT_NEAR(p_F.z(), ground, 1e-5);
  }
}

TEST(Renderer, CountsThePixelsOfEachPlant) {
  Renderer renderer(field_of(some_plants()), clean(), 1);
  const Frame frame = renderer.render(small_camera(), looking_down(1.0, 0.0, 1.0), 0);
  std::int64_t ground = 0;
  std::vector<std::int64_t> counted(renderer.field().plants.size(), 0);
  for (const std::int32_t index : cv::Mat_<std::int32_t>(frame.plant_index)) {
    index < 0 ? ++ground : ++counted.at(static_cast<std::size_t>(index));
  }
  EXPECT_GT(ground, 60000);
  for (const VisiblePlant& visible : frame.plants) {
    EXPECT_EQ(visible.visible_px, counted[visible.plant_index]);
  }
  EXPECT_EQ(counted[4], 0) << "a plant that stands outside the picture";
}

TEST(Renderer, MaskAreaIsThePlantsArea) {
  for (const char* species : {"sugar_beet", "chickweed", "thistle", "pigweed"}) {
    Renderer renderer(field_of({plant(1, species, 1.0, 0.0, 0.06, 5000, 6)}), clean(0.0), 1);
    // From high above, through a long lens, perspective adds little.
    const geometry::PinholeCamera camera({320, 240, 5000, 5000, 159.5, 119.5});
    const Frame frame = renderer.render(camera, looking_down(1.0, 0.0, 6.0), 0);
    ASSERT_EQ(frame.plants.size(), 1u) << species;
    const double seen =
        static_cast<double>(frame.plants[0].visible_px) * camera.pixel_area_mm2(6.0);
    EXPECT_NEAR(seen, frame.plants[0].area_mm2, 0.04 * seen) << species;
    EXPECT_EQ(frame.plants[0].area_mm2, renderer.plant_area_mm2(0));
  }
}

TEST(Renderer, DepthOfLevelGroundIsTheRaysGeometry) {
  RendererParameters p = clean(0.0);
  p.ground.crumb_cover = p.ground.clod_cover = p.ground.stone_cover = p.ground.straw_per_m2 = 0.0;
  p.ground.roughness_mm = 0.0;
  Renderer renderer(field_of({}), p, 1);
  const auto camera = small_camera();
  Eigen::Isometry3d X_FC = looking_down(1.0, 0.0, 1.0);
  X_FC.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(-0.07, Eigen::Vector3d::UnitY()) * X_FC.linear();
  const Frame frame = renderer.render(camera, X_FC, 0);
  for (int v = 0; v < 240; v += 17) {
    for (int u = 0; u < 320; u += 13) {
      const Eigen::Vector3d ray = X_FC.linear() * camera.unproject({u, v}, 1.0);
      // What is left of the ground is within 2 mm of z = 0.
      EXPECT_NEAR(frame.depth_m.at<float>(v, u), -1.0 / ray.z(), 0.003);
    }
  }
}

TEST(Renderer, PlantsAreNearerThanTheGroundBelow) {
  Renderer renderer(field_of({plant(1, "sugar_beet", 1.0, 0.0, 0.08, 11000, 8)}), clean(0.0), 1);
  const Frame frame = renderer.render(small_camera(), looking_down(1.0, 0.0, 1.0), 0);
  float nearest = 10.0f;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (frame.plant_index.at<std::int32_t>(v, u) == 0) {
        nearest = std::min(nearest, frame.depth_m.at<float>(v, u));
        EXPECT_LE(frame.depth_m.at<float>(v, u), 1.0f);
      }
    }
  }
  EXPECT_LT(nearest, 0.985f);
  EXPECT_GT(nearest, 0.88f) << "higher than 1.1 times the largest radius";
}

TEST(Renderer, SameSeedGivesTheSameBytesAfterAnyViews) {
  RendererParameters p = clean();
  p.camera = CameraEffectParameters{};
  Renderer first(field_of(some_plants()), p, 7);
  Renderer second(field_of(some_plants()), p, 7);
  Renderer other(field_of(some_plants()), p, 8);
  const auto camera = small_camera();
  const auto X_FC = looking_down(1.0, 0.1, 1.0);
  (void)first.render(camera, looking_down(8.0, 0.0, 1.5), 3);
  (void)first.render(camera, looking_down(2.2, -1.0, 1.0), 4);
  const Frame a = first.render(camera, X_FC, 5);
  const Frame b = second.render(camera, X_FC, 5);
  EXPECT_TRUE(same_bytes(a, b));
  EXPECT_FALSE(same_bytes(a.bgr, other.render(camera, X_FC, 5).bgr));
  const Frame later = second.render(camera, X_FC, 6);
  EXPECT_FALSE(same_bytes(a.bgr, later.bgr)) << "the noise of another frame";
  EXPECT_TRUE(same_bytes(a.plant_index, later.plant_index));
}

TEST(Renderer, FramesOwnTheirPixels) {
  Renderer renderer(field_of(some_plants()), clean(), 7);
  const Frame first = renderer.render(small_camera(), looking_down(1.0, 0.1, 1.0), 0);
  const cv::Mat bgr = first.bgr.clone();
  const cv::Mat depth_m = first.depth_m.clone();
  (void)renderer.render(small_camera(), looking_down(2.0, 0.1, 0.8), 0);
  EXPECT_TRUE(same_bytes(bgr, first.bgr));
  EXPECT_TRUE(same_bytes(depth_m, first.depth_m));
}

TEST(Renderer, ThreadsDoNotChangeTheBytes) {
  RendererParameters p = random_appearance(3);
  p.ground.ground_resolution_mm = 4.0;
  p.light.robot_shadow = true;
  Renderer one(field_of(some_plants()), p, 7);
  p.threads = 2;
  Renderer two(field_of(some_plants()), p, 7);
  p.threads = 5;
  Renderer five(field_of(some_plants()), p, 7);
  const auto camera = small_camera();
  const auto X_FC = looking_down(1.0, 0.0, 0.9);
  const Frame expected = one.render(camera, X_FC, 1);
  EXPECT_TRUE(same_bytes(expected, two.render(camera, X_FC, 1)));
  EXPECT_TRUE(same_bytes(expected, five.render(camera, X_FC, 1)));
}

TEST(Renderer, WindMovesLeavesAndNoStem) {
  RendererParameters windy = clean();
  windy.plants.leaf_sway_m = 0.02;
  Renderer still(field_of(some_plants()), clean(), 1);
  Renderer moving(field_of(some_plants()), windy, 1);
  const auto render = [](Renderer& renderer, std::uint64_t frame) {
    return renderer.render(small_camera(), looking_down(1.0, 0.0, 1.0), frame);
  };
  const Frame calm = render(still, 0);
  const Frame first = render(moving, 0);
  const Frame second = render(moving, 1);
  EXPECT_FALSE(same_bytes(calm.plant_index, first.plant_index));
  EXPECT_FALSE(same_bytes(first.plant_index, second.plant_index));
  EXPECT_TRUE(same_bytes(first, render(moving, 0))) << "one frame is one picture";
  ASSERT_EQ(first.plants.size(), calm.plants.size());
  for (std::size_t i = 0; i < calm.plants.size(); ++i) {
    EXPECT_EQ(first.plants[i].stem_px, calm.plants[i].stem_px);
    EXPECT_NEAR(static_cast<double>(first.plants[i].visible_px),
                static_cast<double>(calm.plants[i].visible_px),
                0.3 * static_cast<double>(calm.plants[i].visible_px));
  }
}

TEST(Renderer, AnEmptyFieldIsBareGround) {
  Renderer renderer(field_of({}), clean(), 1);
  const Frame frame = renderer.render(small_camera(), looking_down(1.0, 0.0, 1.0), 0);
  EXPECT_TRUE(frame.plants.empty());
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(frame.plant_index, &low, &high);
  EXPECT_EQ(high, -1.0);
  cv::minMaxLoc(frame.depth_m, &low, &high);
  EXPECT_GT(low, 0.9);
}

TEST(Renderer, ExtremePosesGiveAPicture) {
  Renderer renderer(field_of(some_plants()), clean(), 1);
  const auto camera = small_camera();
  const auto turned = [](double pitch_rad, double height_m) {
    Eigen::Isometry3d X_FC = looking_down(1.0, 0.0, height_m);
    X_FC.linear() = Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) * X_FC.linear();
    return X_FC;
  };
  std::vector<Eigen::Isometry3d> poses = {
      turned(-1.4, 1.0),         turned(-1.5708, 1.0), turned(3.1, 1.0),
      turned(0.0, 0.0),          turned(0.0, -1.0),    turned(0.0, 0.09),
      turned(0.0, 400.0),        turned(0.5, 1e300),   looking_down(-900.0, 30.0, 1.0),
      looking_down(1e9, 0, 1.0), turned(0.8, 3.0)};
  poses.push_back(turned(0.0, 1.0));
  poses.back().translation().x() = std::numeric_limits<double>::quiet_NaN();
  for (const auto& X_FC : poses) {
    const Frame frame = renderer.render(camera, X_FC, 0);
    ASSERT_EQ(frame.bgr.size(), cv::Size(320, 240));
    for (const float depth : cv::Mat_<float>(frame.depth_m)) {
      ASSERT_TRUE(std::isfinite(depth) && depth >= 0.0f);
    }
  }
  const Frame nothing = renderer.render(camera, poses.back(), 0);
  EXPECT_EQ(cv::countNonZero(nothing.depth_m), 0);
  const Frame horizon = renderer.render(camera, turned(-1.4, 1.0), 0);
  EXPECT_GT(cv::countNonZero(horizon.depth_m), 0);
  EXPECT_LT(cv::countNonZero(horizon.depth_m), 320 * 240);
}

TEST(Renderer, RefusesInvalidParametersAndPlants) {
  auto plants = some_plants();
  plants[2].p_F_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Renderer(field_of(plants), clean(), 1), ConfigError);
  RendererParameters p = clean();
  p.ground.soil_rgb = {0.5, 0.5};
  EXPECT_THROW(Renderer(field_of({}), p, 1), ConfigError);
  p = clean();
  p.light.exposure = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Renderer(field_of({}), p, 1), ConfigError);
  p = clean();
  p.light.robot_shadow_edge_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Renderer(field_of({}), p, 1), ConfigError);
}

TEST(Renderer, PlantsShadeTheGround) {
  RendererParameters p = clean(0.0);
  p.light.sun_elevation_rad = 0.6;
  p.light.sun_azimuth_rad = 0.0;  // the shadow falls towards -x: below the plant in the picture
  const auto camera = small_camera();
  const auto X_FC = looking_down(1.0, 0.0, 1.0);
  Renderer with(field_of({plant(1, "sugar_beet", 1.0, 0.0, 0.08, 11000, 8)}), p, 1);
  Renderer without(field_of({}), p, 1);
  const Frame shaded = with.render(camera, X_FC, 0);
  const Frame lit = without.render(camera, X_FC, 0);
  double below = 0.0;
  double above = 0.0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (shaded.plant_index.at<std::int32_t>(v, u) >= 0) continue;
      const double loss = lit.bgr.at<cv::Vec3b>(v, u)[1] - shaded.bgr.at<cv::Vec3b>(v, u)[1];
      (v > 120 ? below : above) += loss;
    }
  }
  EXPECT_GT(below, 2000.0);
  EXPECT_GT(below, 3.0 * above);
}

TEST(RandomAppearance, StaysInItsRangesAndVaries) {
  std::set<double> moistures;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RendererParameters p = random_appearance(seed);
    ParameterLister lister;
    p.visit(lister);
    std::vector<GivenParameter> given;
    for (const auto& declared : lister.declared()) {
      given.push_back({declared.info.name, declared.default_value, {}});
    }
    EXPECT_NO_THROW(check_parameters(lister.declared(), given)) << seed;
    moistures.insert(p.ground.moisture);
  }
  EXPECT_EQ(moistures.size(), 200u);
  EXPECT_EQ(random_appearance(5).light.exposure, random_appearance(5).light.exposure);
}

}  // namespace
}  // namespace furrow::simulation
