#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "furrow_core/random.hpp"
#include "furrow_tracking/ground_mask.hpp"
#include "furrow_tracking/ground_region.hpp"
#include "furrow_tracking/reprojection.hpp"

namespace furrow::tracking {
namespace {

using Points = std::vector<Eigen::Vector2d>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

geometry::PinholeCamera camera() {
  return geometry::PinholeCamera({1280, 960, 870.0, 870.0, 639.5, 479.5});
}

/// A camera one metre above the ground that looks straight down, image up towards F's x.
Eigen::Isometry3d looking_down(double x_m, double y_m, double height_m = 1.0) {
  Eigen::Isometry3d X_FC = Eigen::Isometry3d::Identity();
  X_FC.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  X_FC.translation() << x_m, y_m, height_m;
  return X_FC;
}

TEST(GroundRegion, DepthIsTheDistanceFromTheNearestEdge) {
  const GroundRegion region = *GroundRegion::from_bounds({1.0, -0.5}, {2.0, 0.5});
  EXPECT_NEAR(region.depth_inside_m({1.2, 0.0}), 0.2, 1e-12);
  EXPECT_NEAR(region.depth_inside_m({1.5, 0.6}), -0.1, 1e-12);
  EXPECT_TRUE(region.contains({1.0, 0.0}));
  EXPECT_FALSE(region.contains({1.0, 0.0}, 0.01));
  EXPECT_TRUE(region.contains({0.995, 0.0}, -0.01));
  EXPECT_FALSE(GroundRegion().contains({0.0, 0.0}, -1e9));
}

TEST(GroundRegion, CornersMayGoEitherWayRound) {
  const Points clockwise = {{0, 0}, {0, 1}, {1, 0}};
  const GroundRegion region = *GroundRegion::from_corners(clockwise);
  EXPECT_TRUE(region.contains({0.25, 0.25}));
  EXPECT_FALSE(region.contains({0.75, 0.75}));
}

TEST(GroundRegion, RefusesWhatIsNotAConvexPolygon) {
  EXPECT_FALSE(GroundRegion::from_corners(Points{{0, 0}, {1, 0}}).ok());
  EXPECT_FALSE(GroundRegion::from_corners(Points{{0, 0}, {1, 0}, {2, 0}}).ok());
  EXPECT_FALSE(GroundRegion::from_corners(Points{{0, 0}, {1, 0}, {1, 0}, {0, 1}}).ok());
  EXPECT_FALSE(GroundRegion::from_corners(Points{{0, 0}, {4, 0}, {1, 1}, {0, 4}}).ok());
  EXPECT_FALSE(GroundRegion::from_corners(Points{{0, 0}, {1, kNan}, {1, 1}}).ok());
  EXPECT_FALSE(GroundRegion::from_corners(Points(17, Eigen::Vector2d::Zero())).ok());
  Points star;
  for (int i = 0; i < 5; ++i) {
    const double angle = 2.0 * std::numbers::pi * (2 * i % 5) / 5.0;
    star.emplace_back(std::cos(angle), std::sin(angle));
  }
  EXPECT_FALSE(GroundRegion::from_corners(star).ok());
  EXPECT_FALSE(GroundRegion::from_bounds({1, 1}, {0, 2}).ok());
}

TEST(VisibleGround, IsTheImageSizeAtTheCamerasHeight) {
  const GroundRegion region = *visible_ground(camera(), looking_down(1.2, 0.1));
  // 1280 / 870 m across and 960 / 870 m along, about the camera.
  EXPECT_NEAR(region.depth_inside_m({1.2, 0.1}), 480.0 / 870.0, 1e-9);
  EXPECT_NEAR(region.depth_inside_m({1.2, 0.1 + 640.0 / 870.0}), 0.0, 1e-9);
  EXPECT_NEAR(region.depth_inside_m({1.2 + 480.0 / 870.0, 0.1}), 0.0, 1e-9);
  const GroundRegion inner = *visible_ground(camera(), looking_down(1.2, 0.1), 87.0);
  EXPECT_NEAR(inner.depth_inside_m({1.2, 0.1}), 480.0 / 870.0 - 0.1, 1e-9);
}

TEST(VisibleGround, RefusesAViewOfTheHorizon) {
  Eigen::Isometry3d X_FC = looking_down(0.0, 0.0);
  X_FC.rotate(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(visible_ground(camera(), X_FC).ok());
  EXPECT_FALSE(visible_ground(camera(), looking_down(0.0, 0.0, -1.0)).ok());
  EXPECT_FALSE(visible_ground(camera(), looking_down(kNan, 0.0)).ok());
  EXPECT_FALSE(visible_ground(camera(), looking_down(0.0, 0.0), 480.0).ok());
}

std::set<std::pair<int, int>> cells_of(const GroundMask& mask) {
  std::set<std::pair<int, int>> cells;
  for (const GroundMask::Run& run : mask.runs()) {
    for (int column = run.begin; column < run.end; ++column) cells.emplace(run.row, column);
  }
  return cells;
}

TEST(GroundMask, HoldsTheCellsOfItsPoints) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    Points a_points;
    Points b_points;
    for (int i = 0; i < 200; ++i) {
      a_points.emplace_back(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
      b_points.emplace_back(random.uniform(-0.03, 0.07), random.uniform(-0.05, 0.05));
    }
    const double cell_m = 0.005;
    const auto cells = [&](const Points& points) {
      std::set<std::pair<int, int>> expected;
      for (const auto& p : points) {
        expected.emplace(static_cast<int>(std::floor(p.y() / cell_m)),
                         static_cast<int>(std::floor(p.x() / cell_m)));
      }
      return expected;
    };
    const GroundMask a = GroundMask::from_points(a_points, cell_m);
    const GroundMask b = GroundMask::from_points(b_points, cell_m);
    const auto a_cells = cells(a_points);
    const auto b_cells = cells(b_points);
    ASSERT_EQ(cells_of(a), a_cells);
    ASSERT_EQ(a.cell_count(), static_cast<std::int64_t>(a_cells.size()));
    double common = 0.0;
    for (const auto& cell : a_cells) common += b_cells.contains(cell) ? 1.0 : 0.0;
    const double all = static_cast<double>(a_cells.size() + b_cells.size()) - common;
    ASSERT_NEAR(GroundMask::iou(a, b), common / all, 1e-12);
  }
}

TEST(GroundMask, CirclesHaveTheirAreaAndCentre) {
  const Eigen::Vector2d centre(0.3, -0.2);
  const GroundMask mask = GroundMask::from_circle(centre, 0.05, 0.001);
  EXPECT_NEAR(mask.area_mm2(), std::numbers::pi * 2500.0, 40.0);
  EXPECT_NEAR((*mask.centroid() - centre).norm(), 0.0, 1e-3);
  EXPECT_EQ(GroundMask::iou(mask, mask), 1.0);
  EXPECT_EQ(GroundMask::iou(mask, GroundMask::from_circle(centre, 0.05, 0.002)), 0.0);
  EXPECT_EQ(GroundMask::iou(mask, GroundMask()), 0.0);
}

TEST(GroundMask, LeavesOutPointsThatAreNowhere) {
  const GroundMask mask = GroundMask::from_points(
      Points{{kNan, 0.0}, {0.0, std::numeric_limits<double>::infinity()}, {1e9, 0.0}}, 0.001);
  EXPECT_TRUE(mask.empty());
  EXPECT_FALSE(mask.centroid().has_value());
  EXPECT_TRUE(GroundMask::from_circle({kNan, 0.0}, 0.1, 0.001).empty());
}

TEST(Reprojection, FindsThePointThatWasProjected) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    Eigen::Isometry3d X_FC = looking_down(random.uniform(-5, 5), random.uniform(-1, 1));
    X_FC.rotate(
        Eigen::AngleAxisd(random.uniform(-0.2, 0.2), Eigen::Vector3d(1, 1, 1).normalized()));
    const Eigen::Vector3d p_F =
        X_FC.translation() +
        Eigen::Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1.0);
    const Eigen::Vector3d p_C = X_FC.inverse() * p_F;
    const auto found = reproject_point(camera(), X_FC, *camera().project(p_C), p_C.z());
    ASSERT_TRUE(found.ok());
    EXPECT_NEAR((found->p_F_m - p_F).norm(), 0.0, 1e-9);
  }
}

TEST(Reprojection, CovarianceIsThatOfDrawnNoise) {
  const Eigen::Isometry3d X_FC = looking_down(0.0, 0.0);
  const Eigen::Vector2d pixel(1100.0, 200.0);
  const PixelNoise noise = {2.0, 0.01};
  const GroundPoint point = *reproject_point(camera(), X_FC, pixel, 1.0, noise);
  Random random(6);
  Eigen::Matrix2d sample = Eigen::Matrix2d::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector2d noisy = pixel + Eigen::Vector2d(random.normal(0.0, noise.pixel_px),
                                                          random.normal(0.0, noise.pixel_px));
    const auto drawn =
        reproject_point(camera(), X_FC, noisy, 1.0 + random.normal(0.0, noise.depth_m));
    const Eigen::Vector2d error = (drawn->p_F_m - point.p_F_m).head<2>();
    sample += error * error.transpose() / kDraws;
  }
  EXPECT_NEAR((sample - point.covariance_F_m2).norm() / point.covariance_F_m2.norm(), 0.0, 0.05);
}

TEST(Reprojection, RefusesBadInput) {
  const Eigen::Isometry3d X_FC = looking_down(0.0, 0.0);
  for (const double depth : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(reproject_point(camera(), X_FC, {0, 0}, depth).ok());
  }
  EXPECT_FALSE(reproject_point(camera(), X_FC, {kNan, 0}, 1.0).ok());
  EXPECT_FALSE(reproject_point(camera(), looking_down(kNan, 0), {0, 0}, 1.0).ok());
  EXPECT_FALSE(reproject_point(camera(), X_FC, {0, 0}, 1.0, {-1.0, 0.1}).ok());
}

TEST(DepthNear, IsTheMedianOfWhatIsValid) {
  std::vector<float> values(25, 0.0F);
  values[6] = 1.0F;
  values[7] = 9.0F;
  values[12] = 2.0F;
  values[13] = std::numeric_limits<float>::quiet_NaN();
  const DepthImage depth = {values.data(), 5, 5, 5};
  EXPECT_NEAR(*depth_near(depth, {2.0, 2.0}, 1), 2.0, 1e-6);
  EXPECT_EQ(depth_near(depth, {4.0, 4.0}, 0).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(depth_near(depth, {5.0, 2.0}).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(depth_near(depth, {2.0, 2.0}, 65).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(depth_near({}, {2.0, 2.0}).error().code, ErrorCode::kInvalidArgument);
}

TEST(ReprojectMask, CarriesADiscToItsPlaceAndSize) {
  // A disc of 60 px radius about the pixel (700, 400), 1 m below the camera.
  constexpr int kBox = 121;
  std::vector<std::uint8_t> pixels(kBox * kBox, 0);
  std::int64_t count = 0;
  for (int v = 0; v < kBox; ++v) {
    for (int u = 0; u < kBox; ++u) {
      if (std::hypot(u - 60, v - 60) > 60.0) continue;
      pixels[v * kBox + u] = 255;
      ++count;
    }
  }
  std::vector<float> depths(1280 * 960, 1.0F);
  const DepthImage depth = {depths.data(), 1280, 960, 1280};
  InstanceMask mask = {pixels.data(), kBox, kBox, kBox, 640, 340};
  const Eigen::Isometry3d X_FC = looking_down(2.0, 0.3);
  const GroundFootprint footprint = *reproject_mask(camera(), X_FC, mask, depth);
  const Eigen::Vector2d expected(2.0 - (400 - 479.5) / 870.0, 0.3 - (700 - 639.5) / 870.0);
  EXPECT_NEAR((*footprint.mask.centroid() - expected).norm(), 0.0, 0.001);
  EXPECT_NEAR(footprint.radius_m, 60.0 / 870.0, 0.002);
  EXPECT_NEAR(footprint.area_mm2, static_cast<double>(count) * 1e6 / (870.0 * 870.0), 1e-3);
  EXPECT_NEAR(footprint.mask.area_mm2(), footprint.area_mm2, 0.06 * footprint.area_mm2);

  // From another pose the same ground gives the same cells, up to its rim.
  const Eigen::Isometry3d X_FD = looking_down(2.1, 0.3);
  InstanceMask moved = mask;
  moved.v0_px = 340 + 87;
  const GroundFootprint again = *reproject_mask(camera(), X_FD, moved, depth);
  EXPECT_GT(GroundMask::iou(footprint.mask, again.mask), 0.9);
}

TEST(ReprojectMask, RefusesAndCounts) {
  std::vector<std::uint8_t> pixels(4, 1);
  std::vector<float> depths(100, 1.0F);
  depths[0] = 0.0F;
  const geometry::PinholeCamera small({10, 10, 10.0, 10.0, 4.5, 4.5});
  const DepthImage depth = {depths.data(), 10, 10, 10};
  const Eigen::Isometry3d X_FC = looking_down(0.0, 0.0);
  EXPECT_EQ(
      reproject_mask(small, X_FC, {pixels.data(), 2, 2, 2, 0, 0}, depth)->pixels_without_depth, 1);
  EXPECT_FALSE(reproject_mask(small, X_FC, {pixels.data(), 2, 2, 2, 9, 0}, depth).ok());
  EXPECT_FALSE(reproject_mask(small, X_FC, {pixels.data(), 2, 2, 2, -1, 0}, depth).ok());
  EXPECT_FALSE(reproject_mask(small, X_FC, {pixels.data(), 2, 2, 1, 0, 0}, depth).ok());
  EXPECT_FALSE(reproject_mask(small, X_FC, {nullptr, 2, 2, 2, 0, 0}, depth).ok());
  EXPECT_FALSE(reproject_mask(small, X_FC, {pixels.data(), 2, 2, 2, 0, 0}, {}).ok());
  EXPECT_FALSE(reproject_mask(small, X_FC, {pixels.data(), 2, 2, 2, 0, 0}, depth, 0.0).ok());
  const std::vector<std::uint8_t> nothing(4, 0);
  EXPECT_EQ(reproject_mask(small, X_FC, {nothing.data(), 2, 2, 2, 0, 0}, depth).error().code,
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace furrow::tracking
