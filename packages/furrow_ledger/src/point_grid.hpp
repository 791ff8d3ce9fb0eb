#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace furrow::ledger {

/// Finds the points near a place. @pre points are finite and below 1e6 m.
class PointGrid {
 public:
  /// Queries may ask for radii up to `cell_m`. @pre cell_m > 0.
  PointGrid(const std::vector<Eigen::Vector2d>& points, double cell_m)
      : points_(points), cell_m_(cell_m) {
    entries_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      entries_.push_back({cell(points[i].x()), cell(points[i].y()), i});
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls visit(index, distance) for each point within `radius_m` of `p`, the rim included.
  template <class Visit>
  void for_each_within(const Eigen::Vector2d& p, double radius_m, Visit visit) const {
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      const Entry low{cell(p.x()) + dx, cell(p.y()) - 1, 0};
      for (auto it = std::lower_bound(entries_.begin(), entries_.end(), low);
           it != entries_.end() && it->x == low.x && it->y <= low.y + 2; ++it) {
        const double distance_m = (points_[it->index] - p).norm();
        if (distance_m <= radius_m) visit(it->index, distance_m);
      }
    }
  }

 private:
  struct Entry {
    std::int64_t x;
    std::int64_t y;
    std::size_t index;
    bool operator<(const Entry& other) const {
      return std::tie(x, y, index) < std::tie(other.x, other.y, other.index);
    }
  };
  [[nodiscard]] std::int64_t cell(double v_m) const {
    return static_cast<std::int64_t>(std::floor(v_m / cell_m_));
  }

  const std::vector<Eigen::Vector2d>& points_;
  double cell_m_;
  std::vector<Entry> entries_;
};

}  // namespace furrow::ledger
