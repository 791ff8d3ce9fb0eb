#include "furrow_core/point_grid.hpp"

#include <gtest/gtest.h>

#include <set>

#include "furrow_core/random.hpp"

namespace furrow {
namespace {

struct XY {
  double x_ = 0.0, y_ = 0.0;
  [[nodiscard]] double x() const { return x_; }
  [[nodiscard]] double y() const { return y_; }
};

double distance(const XY& a, const XY& b) {
  return std::hypot(a.x() - b.x(), a.y() - b.y());
}

std::vector<XY> random_points(Random& random, std::int64_t count, double span) {
  std::vector<XY> points;
  for (std::int64_t i = 0; i < count; ++i) {
    points.push_back({random.uniform(-span, span), random.uniform(-span, span)});
  }
  return points;
}

TEST(PointGrid, FindsWhatASearchOfAllPointsFinds) {
  Random random(3);
  PointGrid<XY> grid;
  for (int round = 0; round < 200; ++round) {
    const std::vector<XY> points = random_points(random, random.integer(1, 60), 2.0);
    grid.build(points, random.uniform(0.01, 1.0));
    const XY centre{random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)};
    const double radius = random.uniform(0.0, 2.0);
    std::set<std::size_t> expected, found;
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (distance(points[i], centre) > radius) continue;
      expected.insert(i);
      if (!nearest || distance(points[i], centre) < distance(points[*nearest], centre)) nearest = i;
    }
    grid.for_each_within(centre, radius, [&](std::size_t i, double d) {
      EXPECT_TRUE(found.insert(i).second);
      EXPECT_NEAR(d, distance(points[i], centre), 1e-12);
    });
    EXPECT_EQ(found, expected);
    EXPECT_EQ(grid.nearest(centre, radius), nearest);
  }
}

TEST(PointGrid, IncludesTheRim) {
  const std::vector<XY> points = {{1.0, 0.0}, {0.0, 2.0}};
  const PointGrid<XY> grid(points, 0.5);
  EXPECT_EQ(grid.nearest({0.0, 0.0}, 1.0), 0u);
  EXPECT_FALSE(grid.nearest({0.0, 0.0}, 0.99).has_value());
}

TEST(PointGrid, OfSeveralNearestTheFirstCounts) {
  const std::vector<XY> points = {{0.0, 1.0}, {0.0, -1.0}, {1.0, 0.0}};
  EXPECT_EQ(PointGrid<XY>(points, 0.1).nearest({0.0, 0.0}, 5.0), 0u);
}

TEST(PointGrid, BoundsItsCellsWhereverThePointsAre) {
  const std::vector<XY> points = {{-1e6, -1e6}, {1e6, 1e6}, {1e6, 1e6 - 0.5}};
  const PointGrid<XY> grid(points, 1e-3);
  EXPECT_EQ(grid.nearest({1e6, 1e6 - 0.4}, 1.0), 2u);
}

TEST(PointGrid, FindsNothingNearAPlaceThatIsNotFinite) {
  const std::vector<XY> points = {{0.0, 0.0}};
  const PointGrid<XY> grid(points, 1.0);
  EXPECT_FALSE(grid.nearest({std::nan(""), 0.0}, 1e9).has_value());
  EXPECT_FALSE(grid.nearest({0.0, std::numeric_limits<double>::infinity()}, 1e9).has_value());
}

TEST(PointGrid, OfNothingFindsNothing) {
  PointGrid<XY> grid;
  EXPECT_FALSE(grid.nearest({0.0, 0.0}, 1.0).has_value());
  grid.build({}, 1.0);
  EXPECT_FALSE(grid.nearest({0.0, 0.0}, 1.0).has_value());
}

}  // namespace
}  // namespace furrow
