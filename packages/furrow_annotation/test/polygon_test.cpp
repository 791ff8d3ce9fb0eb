#include "furrow_annotation/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>

#include "furrow_core/random.hpp"

namespace furrow::annotation {
namespace {

std::uint32_t area_of(const RunLengths& runs) {
  std::uint32_t area = 0;
  for (std::size_t i = 1; i < runs.size(); i += 2) area += runs[i];
  return area;
}

std::uint32_t pixels_of(const RunLengths& runs) {
  return std::accumulate(runs.begin(), runs.end(), 0u);
}

TEST(PolygonMask, ASquareOnPixelEdgesHoldsThePixelsBetween) {
  // 3 rows, 4 columns. Columns 1 and 2, row 1: runs 4, 1, 2, 1, 4 down the columns.
  EXPECT_EQ(polygon_run_lengths({{1, 1}, {3, 1}, {3, 2}, {1, 2}}, {4, 3}),
            (RunLengths{4, 1, 2, 1, 4}));
}

TEST(PolygonMask, TheOrientationDoesNotMatter) {
  EXPECT_EQ(polygon_run_lengths({{1, 1}, {1, 2}, {3, 2}, {3, 1}}, {4, 3}),
            (RunLengths{4, 1, 2, 1, 4}));
}

TEST(PolygonMask, AWholeImageIsOneRun) {
  EXPECT_EQ(polygon_run_lengths({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {4, 3}), (RunLengths{0, 12}));
  EXPECT_EQ(polygon_run_lengths({{-9, -9}, {40, -9}, {40, 30}, {-9, 30}}, {4, 3}),
            (RunLengths{0, 12}));
}

TEST(PolygonMask, NeighbouringColumnsJoinInOneRun) {
  // Columns 1 and 2 whole: one run of 6.
  EXPECT_EQ(polygon_run_lengths({{1, 0}, {3, 0}, {3, 3}, {1, 3}}, {4, 3}), (RunLengths{3, 6, 3}));
}

TEST(PolygonMask, WithoutAreaOrBesideTheImageNothingIsSet) {
  EXPECT_EQ(area_of(polygon_run_lengths({{0, 1}, {4, 1}, {2, 1}}, {4, 3})), 0u);
  EXPECT_EQ(area_of(polygon_run_lengths({{9, 0}, {12, 0}, {12, 3}}, {4, 3})), 0u);
  EXPECT_EQ(area_of(polygon_run_lengths({}, {4, 3})), 0u);
}

TEST(PolygonMask, CrossingLinesCountEvenOdd) {
  // A frame of one pixel's width, its inner square drawn by a second lap.
  const CornerPolygon frame = {{0, 0}, {5, 0}, {5, 5}, {0, 5}, {0, 0},
                               {1, 1}, {1, 4}, {4, 4}, {4, 1}, {1, 1}};
  EXPECT_EQ(area_of(polygon_run_lengths(frame, {6, 6})), 25u - 9u);
}

/// Whether a point is inside by the even-odd rule, and how far it is from the outline.
std::pair<bool, double> inside_and_distance(const CornerPolygon& polygon,
                                            const Eigen::Vector2d& p) {
  bool inside = false;
  double distance = 1e9;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
    const Eigen::Vector2d edge = b - a;
    const double along =
        std::clamp((p - a).dot(edge) / std::max(edge.squaredNorm(), 1e-12), 0.0, 1.0);
    distance = std::min(distance, (p - a - along * edge).norm());
  }
  return {inside, distance};
}

TEST(PolygonMask, HoldsThePixelsWhoseCentresAreInside) {
  Random random(5);
  const cv::Size size(60, 50);
  for (int round = 0; round < 100; ++round) {
    CornerPolygon polygon;
    const auto corners = random.integer(3, 12);
    for (std::int64_t i = 0; i < corners; ++i) {
      polygon.emplace_back(random.uniform(-10.0, 70.0), random.uniform(-10.0, 60.0));
    }
    const RunLengths runs = polygon_run_lengths(polygon, size);
    ASSERT_EQ(pixels_of(runs), 3000u);
    const auto mask = decode_run_lengths(runs, size);
    ASSERT_TRUE(mask.ok());
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u) {
        const bool set = mask->box_px.contains({u, v}) &&
                         mask->pixels.at<std::uint8_t>(v - mask->box_px.y, u - mask->box_px.x) != 0;
        const auto [inside, distance] = inside_and_distance(polygon, {u + 0.5, v + 0.5});
        // The grid of a fifth of a pixel leaves a doubt of its diagonal near the outline.
        if (distance > 0.3) {
          ASSERT_EQ(set, inside) << u << ", " << v << " in round " << round;
        }
      }
    }
  }
}

TEST(PolygonMask, AreaIsThatOfThePolygonOnAverage) {
  Random random(6);
  double pixels = 0.0, exact = 0.0;
  for (int round = 0; round < 300; ++round) {
    const double radius = random.uniform(3.0, 12.0);
    const Eigen::Vector2d middle(random.uniform(20.0, 21.0), random.uniform(20.0, 21.0));
    CornerPolygon polygon;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 24;
      polygon.push_back(middle + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    pixels += area_of(polygon_run_lengths(polygon, {41, 41}));
    exact += 12.0 * radius * radius * std::sin(2.0 * std::numbers::pi / 24);
  }
  EXPECT_NEAR(pixels / exact, 1.0, 0.01);
}

TEST(Unite, SetsWhatAnyMaskSets) {
  EXPECT_EQ(unite({}), RunLengths{});
  EXPECT_EQ(unite({{2, 3, 5}}), (RunLengths{2, 3, 5}));
  EXPECT_EQ(unite({{2, 3, 5}, {4, 2, 4}}), (RunLengths{2, 4, 4}));
  EXPECT_EQ(unite({{0, 2, 8}, {8, 2}, {2, 6, 2}}), (RunLengths{0, 10}));
  EXPECT_EQ(unite({{10}, {10}}), (RunLengths{10}));
}

}  // namespace
}  // namespace furrow::annotation
