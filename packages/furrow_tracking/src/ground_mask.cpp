#include "furrow_tracking/ground_mask.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::tracking {
namespace {

constexpr double kMaxCell = 1e6;

struct Cell {
  std::int32_t row;
  std::int32_t column;
  bool operator==(const Cell&) const = default;
};

std::vector<Cell> cells_of(std::span<const Eigen::Vector2d> points_F, double cell_m) {
  std::vector<Cell> cells;
  cells.reserve(points_F.size());
  for (const Eigen::Vector2d& point : points_F) {
    const double column = std::floor(point.x() / cell_m);
    const double row = std::floor(point.y() / cell_m);
    if (!(std::abs(column) <= kMaxCell) || !(std::abs(row) <= kMaxCell)) continue;
    const Cell cell = {static_cast<std::int32_t>(row), static_cast<std::int32_t>(column)};
    // Neighbouring pixels often fall into the same cell.
    if (cells.empty() || cells.back() != cell) cells.push_back(cell);
  }
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

}  // namespace

GroundMask GroundMask::from_points(std::span<const Eigen::Vector2d> points_F, double cell_m) {
  GroundMask mask;
  mask.cell_m_ = cell_m;
  for (const Cell& cell : cells_of(points_F, cell_m)) {
    if (!mask.runs_.empty() && mask.runs_.back().row == cell.row &&
        mask.runs_.back().end == cell.column) {
      ++mask.runs_.back().end;
    } else {
      mask.runs_.push_back({cell.row, cell.column, cell.column + 1});
    }
  }
  return mask;
}

GroundMask GroundMask::from_circle(const Eigen::Vector2d& centre_F, double radius_m,
                                   double cell_m) {
  GroundMask mask;
  mask.cell_m_ = cell_m;
  const Eigen::Vector2d centre = centre_F / cell_m;
  const double radius = radius_m / cell_m;
  if (!centre.allFinite() || !(centre.cwiseAbs().maxCoeff() <= kMaxCell) || !(radius <= 1e4)) {
    return mask;
  }
  const auto first = static_cast<std::int32_t>(std::floor(centre.y() - radius - 0.5));
  const auto last = static_cast<std::int32_t>(std::ceil(centre.y() + radius));
  for (std::int32_t row = first; row <= last; ++row) {
    const double offset = row + 0.5 - centre.y();
    const double square = radius * radius - offset * offset;
    if (square < 0.0) continue;
    const double half = std::sqrt(square);
    const auto begin = static_cast<std::int32_t>(std::ceil(centre.x() - half - 0.5));
    const auto end = static_cast<std::int32_t>(std::floor(centre.x() + half - 0.5)) + 1;
    if (begin < end) mask.runs_.push_back({row, begin, end});
  }
  return mask;
}

std::int64_t GroundMask::cell_count() const {
  std::int64_t count = 0;
  for (const Run& run : runs_) count += run.end - run.begin;
  return count;
}

double GroundMask::area_mm2() const {
  return static_cast<double>(cell_count()) * cell_m_ * cell_m_ * 1e6;
}

std::optional<Eigen::Vector2d> GroundMask::centroid() const {
  if (empty()) return std::nullopt;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Run& run : runs_) {
    const double cells = run.end - run.begin;
    sum += cells * Eigen::Vector2d(0.5 * (run.begin + run.end), run.row + 0.5);
  }
  return Eigen::Vector2d(sum * (cell_m_ / static_cast<double>(cell_count())));
}

double GroundMask::iou(const GroundMask& a, const GroundMask& b) {
  if (a.empty() || b.empty() || a.cell_m_ != b.cell_m_) return 0.0;
  std::int64_t common = 0;
  for (std::size_t i = 0, j = 0; i < a.runs_.size() && j < b.runs_.size();) {
    const Run& p = a.runs_[i];
    const Run& q = b.runs_[j];
    if (p.row != q.row) {
      ++(p.row < q.row ? i : j);
      continue;
    }
    common += std::max(0, std::min(p.end, q.end) - std::max(p.begin, q.begin));
    ++(p.end < q.end ? i : j);
  }
  return static_cast<double>(common) /
         static_cast<double>(a.cell_count() + b.cell_count() - common);
}

}  // namespace furrow::tracking
