#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace furrow::tracking {

/// Points in the plane by the cells of a uniform grid, to find those near a place. Cost of building
/// is linear in the points; the number of cells is bounded by kMaxCells.
class PointGrid {
 public:
  static constexpr double kMaxCells = 65536.0;

  /// @pre points finite; cell_m > 0.
  void build(std::span<const Eigen::Vector2d> points, double cell_m) {
    points_ = points;
    if (points.empty()) return;
    Eigen::Vector2d upper = points[0];
    lower_ = points[0];
    for (const Eigen::Vector2d& p : points) {
      lower_ = lower_.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    const Eigen::Vector2d extent = upper - lower_;
    cell_m_ = cell_m;
    while ((std::floor(extent.x() / cell_m_) + 1.0) * (std::floor(extent.y() / cell_m_) + 1.0) >
           kMaxCells) {
      cell_m_ *= 2.0;
    }
    columns_ = static_cast<std::int32_t>(extent.x() / cell_m_) + 1;
    rows_ = static_cast<std::int32_t>(extent.y() / cell_m_) + 1;
    first_.assign(static_cast<std::size_t>(rows_) * columns_ + 1, 0);
    for (const Eigen::Vector2d& p : points) ++first_[cell_of(p) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    fill_.assign(first_.begin(), first_.end() - 1);
    members_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      members_[fill_[cell_of(points[i])]++] = static_cast<std::int32_t>(i);
    }
  }

  /// Calls `visit(index, distance_m)` for each point within `radius_m` of `centre`.
  template <class Visitor>
  void for_each_near(const Eigen::Vector2d& centre, double radius_m, Visitor&& visit) const {
    if (points_.empty()) return;
    const std::int32_t left = clamped(centre.x() - radius_m - lower_.x(), columns_);
    const std::int32_t right = clamped(centre.x() + radius_m - lower_.x(), columns_);
    const std::int32_t bottom = clamped(centre.y() - radius_m - lower_.y(), rows_);
    const std::int32_t top = clamped(centre.y() + radius_m - lower_.y(), rows_);
    for (std::int32_t row = bottom; row <= top; ++row) {
      const std::int32_t end = first_[row * columns_ + right + 1];
      for (std::int32_t m = first_[row * columns_ + left]; m < end; ++m) {
        const double distance_m = (points_[members_[m]] - centre).norm();
        if (distance_m <= radius_m) visit(members_[m], distance_m);
      }
    }
  }

 private:
  [[nodiscard]] std::int32_t clamped(double offset_m, std::int32_t count) const {
    return static_cast<std::int32_t>(std::clamp(offset_m / cell_m_, 0.0, count - 1.0));
  }
  [[nodiscard]] std::int32_t cell_of(const Eigen::Vector2d& p) const {
    return clamped(p.y() - lower_.y(), rows_) * columns_ + clamped(p.x() - lower_.x(), columns_);
  }

  std::span<const Eigen::Vector2d> points_;
  Eigen::Vector2d lower_ = Eigen::Vector2d::Zero();
  double cell_m_ = 1.0;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::vector<std::int32_t> first_;
  std::vector<std::int32_t> fill_;
  std::vector<std::int32_t> members_;
};

}  // namespace furrow::tracking
