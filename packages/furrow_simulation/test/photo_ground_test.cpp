#include "furrow_simulation/photo_ground.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "furrow_core/error.hpp"
#include "scene_fixture.hpp"

namespace furrow::simulation {
namespace {

// A photo with a green disc of 20 px at (60, 40), and a small red square at (150, 90).
GroundPhoto photo() {
  GroundPhoto p;
  p.bgr.create(120, 200, CV_8UC3);
  p.bgr.setTo(cv::Scalar(60, 80, 100));
  p.instance_id.create(120, 200, CV_32SC1);
  p.instance_id.setTo(-1);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 200; ++u) {
      if (std::hypot(u - 60, v - 40) <= 20.0) {
        p.instance_id.at<std::int32_t>(v, u) = 0;
        p.bgr.at<cv::Vec3b>(v, u) = {20, 200, 20};
      } else if (std::abs(u - 150) <= 5 && std::abs(v - 90) <= 5) {
        p.instance_id.at<std::int32_t>(v, u) = 1;
        p.bgr.at<cv::Vec3b>(v, u) = {10, 10, 220};
      }
    }
  }
  p.plants = {{field::PlantKind::kCrop, "carrot", Eigen::Vector2d(60, 40)},
              {field::PlantKind::kWeed, "weed", std::nullopt}};
  return p;
}

PhotoGroundParameters parameters(double length_m, double width_m) {
  PhotoGroundParameters p;
  p.photo_resolution_mm_per_px = 2.0;
  p.length_m = length_m;
  p.width_m = width_m;
  return p;
}

TEST(PhotoGround, OnePhotoGivesItsPlants) {
  const PhotoGround ground({photo()}, parameters(0.24, 0.4), 1);
  const auto& plants = ground.field().plants;
  ASSERT_EQ(plants.size(), 2u);
  // Rows count downwards from x = 0.24 m, columns to the right from y = 0.2 m.
  EXPECT_EQ(plants[0].species, "weed");
  EXPECT_NEAR(plants[0].p_F_m.x(), 0.24 - 90.5 * 0.002, 1e-9);
  EXPECT_NEAR(plants[0].p_F_m.y(), 0.2 - 150.5 * 0.002, 1e-9);
  EXPECT_NEAR(plants[0].area_mm2, 121 * 4.0, 1e-6);
  EXPECT_EQ(plants[1].kind, field::PlantKind::kCrop);
  EXPECT_NEAR(plants[1].p_F_m.x(), 0.24 - 40.5 * 0.002, 1e-9);
  EXPECT_NEAR(plants[1].area_mm2, std::numbers::pi * 1600.0, 60.0);
  EXPECT_NEAR(plants[1].radius_m, 0.04, 1e-6);
}

TEST(PhotoGround, FramesShowThePlantsWhereTheFieldHasThem) {
  for (const int turns : {0, 1, 2, 3}) {
    auto p = parameters(1.5, 1.6);
    p.quarter_turns = turns;
    PhotoGround ground({photo(), photo()}, p, 5);
    EXPECT_GT(ground.field().plants.size(), 30u);
    const auto camera = small_camera();
    const auto X_FC = looking_down(0.75, 0.0, 0.6);
    const Frame frame = ground.render(camera, X_FC, 0);
    ASSERT_GT(frame.plants.size(), 8u);
    for (const VisiblePlant& visible : frame.plants) {
      const auto& plant = ground.field().plants[visible.plant_index];
      const Eigen::Vector3d p_F = X_FC * camera.unproject(visible.stem_px, 0.6);
      EXPECT_NEAR(p_F.x(), plant.p_F_m.x(), 1e-9);
      EXPECT_NEAR(p_F.y(), plant.p_F_m.y(), 1e-9);
      const cv::Point at(static_cast<int>(std::lround(visible.stem_px.x())),
                         static_cast<int>(std::lround(visible.stem_px.y())));
      if (at.x < 0 || at.y < 0 || at.x >= 320 || at.y >= 240) continue;
      EXPECT_EQ(frame.plant_index.at<std::int32_t>(at), static_cast<int>(visible.plant_index));
      EXPECT_NEAR(frame.depth_m.at<float>(at), 0.6, 1e-6);
      const cv::Vec3b color = frame.bgr.at<cv::Vec3b>(at);
      EXPECT_GT(plant.kind == field::PlantKind::kCrop ? color[1] : color[2], 180);
    }
  }
}

TEST(PhotoGround, SameBytesOnAnyNumberOfThreads) {
  auto p = parameters(1.5, 1.6);
  p.camera = CameraEffectParameters{};
  PhotoGround one({photo()}, p, 5);
  p.threads = 3;
  PhotoGround three({photo()}, p, 5);
  const auto X_FC = looking_down(0.7, 0.1, 0.8);
  EXPECT_TRUE(
      same_bytes(one.render(small_camera(), X_FC, 2), three.render(small_camera(), X_FC, 2)));
}

TEST(PhotoGround, ExtremePosesGiveAPicture) {
  PhotoGround ground({photo()}, parameters(1.5, 1.6), 5);
  for (auto X_FC :
       {looking_down(100.0, 0.0, 1.0), looking_down(1.0, 0.0, -1.0), looking_down(1.0, 0.0, 1e9),
        looking_down(std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0)}) {
    EXPECT_TRUE(ground.render(small_camera(), X_FC, 0).plants.empty());
  }
  Eigen::Isometry3d up = looking_down(0.7, 0.0, 1.0);
  up.linear() = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitY()) * up.linear();
  EXPECT_NO_THROW((void)ground.render(small_camera(), up, 0));
}

TEST(PhotoGround, RefusesPhotosThatDoNotFit) {
  EXPECT_THROW(PhotoGround({}, parameters(1, 1), 1), ConfigError);
  GroundPhoto bad = photo();
  bad.plants.pop_back();
  EXPECT_THROW(PhotoGround({bad}, parameters(1, 1), 1), ConfigError);
  bad = photo();
  bad.instance_id = bad.instance_id(cv::Rect(0, 0, 100, 100)).clone();
  EXPECT_THROW(PhotoGround({bad}, parameters(1, 1), 1), ConfigError);
  GroundPhoto smaller = photo();
  smaller.bgr = smaller.bgr(cv::Rect(0, 0, 100, 100)).clone();
  smaller.instance_id = smaller.instance_id(cv::Rect(0, 0, 100, 100)).clone();
  EXPECT_THROW(PhotoGround({photo(), smaller}, parameters(1, 1), 1), ConfigError);
  EXPECT_THROW(PhotoGround({photo()}, parameters(1e6, 1e6), 1), ConfigError);
  EXPECT_THROW(PhotoGround({photo()}, parameters(-1.0, 1), 1), ConfigError);
  auto p = parameters(1, 1);
  p.photo_resolution_mm_per_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PhotoGround({photo()}, p, 1), ConfigError);
}

}  // namespace
}  // namespace furrow::simulation
