#include "furrow_geometry/camera.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"

namespace furrow::geometry {
namespace {

const CameraIntrinsics kIntrinsics{1280, 960, 870.0, 860.0, 639.5, 479.5};

TEST(PinholeCamera, ProjectsByHand) {
  const PinholeCamera camera(kIntrinsics);
  const auto pixel = camera.project({0.2, -0.1, 2.0});
  ASSERT_TRUE(pixel.has_value());
  EXPECT_NEAR(pixel->x(), 639.5 + 87.0, 1e-9);
  EXPECT_NEAR(pixel->y(), 479.5 - 43.0, 1e-9);
}

TEST(PinholeCamera, UnprojectUndoesProject) {
  const PinholeCamera camera(kIntrinsics);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p_C(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0.1, 5));
    const auto pixel = camera.project(p_C);
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR((camera.unproject(*pixel, p_C.z()) - p_C).norm(), 0.0, 1e-9);
  }
}

TEST(PinholeCamera, SeesNothingBehindIt) {
  const PinholeCamera camera(kIntrinsics);
  EXPECT_FALSE(camera.project({0, 0, 0}).has_value());
  EXPECT_FALSE(camera.project({0, 0, -1}).has_value());
  EXPECT_FALSE(camera.project({0, 0, std::numeric_limits<double>::quiet_NaN()}).has_value());
}

TEST(PinholeCamera, TheImageEndsAtTheOuterEdgesOfItsPixels) {
  const PinholeCamera camera(kIntrinsics);
  EXPECT_TRUE(camera.in_image({-0.5, -0.5}));
  EXPECT_TRUE(camera.in_image({1279.49, 959.49}));
  EXPECT_FALSE(camera.in_image({1279.5, 0}));
  EXPECT_FALSE(camera.in_image({0, 959.5}));
  EXPECT_FALSE(camera.in_image({-0.51, 0}));
}

TEST(PinholeCamera, PixelAreaIsTheGroundBetweenNeighbouringPixels) {
  const PinholeCamera camera(kIntrinsics);
  const double depth_m = 1.3;
  const Eigen::Vector3d corner = camera.unproject({100, 100}, depth_m);
  const Eigen::Vector3d across = camera.unproject({101, 100}, depth_m);
  const Eigen::Vector3d down = camera.unproject({100, 101}, depth_m);
  EXPECT_NEAR(camera.pixel_area_mm2(depth_m),
              1e6 * (across - corner).norm() * (down - corner).norm(), 1e-9);
}

TEST(PinholeCamera, RefusesImpossibleIntrinsics) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const CameraIntrinsics& bad :
       {CameraIntrinsics{0, 960, 870, 870, 0, 0}, CameraIntrinsics{1280, -1, 870, 870, 0, 0},
        CameraIntrinsics{1280, 960, 0, 870, 0, 0}, CameraIntrinsics{1280, 960, 870, nan, 0, 0},
        CameraIntrinsics{1280, 960, 870, 870, nan, 0}}) {
    EXPECT_THROW(PinholeCamera{bad}, ConfigError);
  }
}

}  // namespace
}  // namespace furrow::geometry
