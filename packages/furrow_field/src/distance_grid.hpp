#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace furrow::field {

/// Distance queries on points that are inserted one by one, by a hash grid. Unlike
/// furrow::PointGrid it grows. Queried distances must not exceed the cell size.
class DistanceGrid {
 public:
  explicit DistanceGrid(double cell_m) : cell_m_(cell_m) {}

  void insert(const Eigen::Vector2d& p_m) {
    cells_[key(index(p_m.x()), index(p_m.y()))].push_back(p_m);
  }

  [[nodiscard]] bool any_within(const Eigen::Vector2d& p_m, double distance_m) const {
    const std::int64_t cx = index(p_m.x());
    const std::int64_t cy = index(p_m.y());
    for (std::int64_t x = cx - 1; x <= cx + 1; ++x) {
      for (std::int64_t y = cy - 1; y <= cy + 1; ++y) {
        const auto found = cells_.find(key(x, y));
        if (found == cells_.end()) continue;
        for (const Eigen::Vector2d& other_m : found->second) {
          if ((other_m - p_m).norm() < distance_m) return true;
        }
      }
    }
    return false;
  }

 private:
  [[nodiscard]] std::int64_t index(double value_m) const {
    return static_cast<std::int64_t>(std::floor(value_m / cell_m_));
  }
  static std::int64_t key(std::int64_t x, std::int64_t y) { return x * 4'000'037 + y; }

  double cell_m_;
  std::unordered_map<std::int64_t, std::vector<Eigen::Vector2d>> cells_;
};

}  // namespace furrow::field
