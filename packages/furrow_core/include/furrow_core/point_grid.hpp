#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace furrow {

/// Radius and nearest-neighbour queries on points in the plane, by a uniform grid. `Point` has x()
/// and y(), such as Eigen::Vector2d. build() is linear in the number of points, reuses the memory
/// of the previous grid and makes at most kMaxCells cells. Const calls are thread-safe.
template <class Point>
class PointGrid {
 public:
  static constexpr double kMaxCells = 65536.0;

  PointGrid() = default;
  PointGrid(std::span<const Point> points, double cell) { build(points, cell); }

  /// Refers to `points`, which must outlive the queries. Queries are fastest for radii near `cell`;
  /// cells are made larger where there would be too many. @pre points finite; cell > 0.
  void build(std::span<const Point> points, double cell);

  /// Calls `visit(index, distance)` for each point within `radius` of `centre`, the rim included:
  /// cell by cell, within a cell in the order of the points. Finds nothing when the centre is not
  /// finite.
  template <class Visit>
  void for_each_within(const Point& centre, double radius, Visit&& visit) const;

  /// The point nearest to `centre` of those within `radius`, the rim included; of several the
  /// first.
  [[nodiscard]] std::optional<std::size_t> nearest(const Point& centre, double radius) const;

 private:
  [[nodiscard]] std::int32_t clamped(double offset, std::int32_t count) const {
    return static_cast<std::int32_t>(std::clamp(offset / cell_, 0.0, count - 1.0));
  }
  [[nodiscard]] std::size_t cell_of(const Point& p) const {
    return static_cast<std::size_t>(clamped(p.y() - low_y_, rows_)) * columns_ +
           clamped(p.x() - low_x_, columns_);
  }

  std::span<const Point> points_;
  double low_x_ = 0.0;
  double low_y_ = 0.0;
  double cell_ = 1.0;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::vector<std::uint32_t> first_;    ///< of each cell, into members_; one more at the end
  std::vector<std::uint32_t> fill_;     ///< while building
  std::vector<std::uint32_t> members_;  ///< indices of points, cell by cell
};

template <class Point>
void PointGrid<Point>::build(std::span<const Point> points, double cell) {
  points_ = points;
  if (points.empty()) return;
  double high_x = points[0].x(), high_y = points[0].y();
  low_x_ = high_x;
  low_y_ = high_y;
  for (const Point& p : points) {
    low_x_ = std::min(low_x_, p.x());
    low_y_ = std::min(low_y_, p.y());
    high_x = std::max(high_x, p.x());
    high_y = std::max(high_y, p.y());
  }
  const double width = high_x - low_x_, height = high_y - low_y_;
  cell_ = cell;
  while ((std::floor(width / cell_) + 1.0) * (std::floor(height / cell_) + 1.0) > kMaxCells) {
    cell_ *= 2.0;
  }
  columns_ = static_cast<std::int32_t>(width / cell_) + 1;
  rows_ = static_cast<std::int32_t>(height / cell_) + 1;
  first_.assign(static_cast<std::size_t>(rows_) * columns_ + 1, 0);
  for (const Point& p : points) ++first_[cell_of(p) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  fill_.assign(first_.begin(), first_.end() - 1);
  members_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    members_[fill_[cell_of(points[i])]++] = static_cast<std::uint32_t>(i);
  }
}

template <class Point>
template <class Visit>
void PointGrid<Point>::for_each_within(const Point& centre, double radius, Visit&& visit) const {
  if (points_.empty() || !std::isfinite(centre.x() + centre.y() + radius)) return;
  const std::int32_t left = clamped(centre.x() - radius - low_x_, columns_);
  const std::int32_t right = clamped(centre.x() + radius - low_x_, columns_);
  const std::int32_t bottom = clamped(centre.y() - radius - low_y_, rows_);
  const std::int32_t top = clamped(centre.y() + radius - low_y_, rows_);
  for (std::int32_t row = bottom; row <= top; ++row) {
    const std::size_t start = static_cast<std::size_t>(row) * columns_;
    const std::uint32_t end = first_[start + right + 1];
    for (std::uint32_t m = first_[start + left]; m < end; ++m) {
      const Point& p = points_[members_[m]];
      const double dx = p.x() - centre.x(), dy = p.y() - centre.y();
      const double distance = std::sqrt(dx * dx + dy * dy);
      if (distance <= radius) visit(static_cast<std::size_t>(members_[m]), distance);
    }
  }
}

template <class Point>
std::optional<std::size_t> PointGrid<Point>::nearest(const Point& centre, double radius) const {
  std::optional<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for_each_within(centre, radius, [&](std::size_t index, double distance) {
    if (distance < least || (distance == least && index < *best)) {
      least = distance;
      best = index;
    }
  });
  return best;
}

}  // namespace furrow
