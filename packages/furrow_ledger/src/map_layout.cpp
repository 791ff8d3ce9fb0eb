#include "map_layout.hpp"

#include <numbers>

namespace furrow::ledger {
namespace {

constexpr double kStripLength_m = 5.0;
constexpr double kMostStrips = 60.0;
constexpr double kMaxCoordinate_m = 1e6;

/// The directions from a point in which a line passes near every point seen since.
class Cone {
 public:
  explicit Cone(double tolerance_m) : tolerance_m_(tolerance_m) {}

  void reset() {
    open_ = false;
    farthest_m_ = 0.0;
  }
  /// Narrows the cone to `d`; false, and the cone as it was, when no line fits any more.
  bool narrow(const Eigen::Vector2d& d) {
    const double length_m = d.norm();
    if (length_m < farthest_m_ - tolerance_m_) return false;  // it turns back
    if (length_m <= tolerance_m_) return true;
    double angle = std::atan2(d.y(), d.x());
    const double spread = std::asin(tolerance_m_ / length_m);
    if (open_) {
      const double middle = (low_ + high_) / 2;
      angle = middle + std::remainder(angle - middle, 2 * std::numbers::pi);
      if (angle < low_ || angle > high_) return false;
    }
    low_ = open_ ? std::max(low_, angle - spread) : angle - spread;
    high_ = open_ ? std::min(high_, angle + spread) : angle + spread;
    open_ = true;
    farthest_m_ = std::max(farthest_m_, length_m);
    return true;
  }

 private:
  double tolerance_m_;
  double low_ = 0.0;
  double high_ = 0.0;
  double farthest_m_ = 0.0;
  bool open_ = false;
};

}  // namespace

bool is_place(const Eigen::Vector2d& p) {
  return std::abs(p.x()) <= kMaxCoordinate_m && std::abs(p.y()) <= kMaxCoordinate_m;
}

MapLayout make_map_layout(const Ledger& ledger, double max_length_m) {
  MapLayout layout;
  double length_m = ledger.length_m;
  double half_width_m = ledger.width_m / 2;
  for (const LedgerRow& row : ledger.rows) {
    if (!(ledger.length_m > 0.0)) length_m = std::max(length_m, row.p_F_m.x() + row.radius_m);
    if (!(ledger.width_m > 0.0)) half_width_m = std::max(half_width_m, std::abs(row.p_F_m.y()));
  }
  if (!(length_m > 0.1 && length_m <= kMaxCoordinate_m)) length_m = 1.0;
  if (!(half_width_m > 0.05 && half_width_m <= 100.0)) half_width_m = 0.7;
  length_m = std::min(length_m, max_length_m);
  layout.to_m = length_m;
  layout.strip_m = length_m <= 1.2 * kStripLength_m
                       ? length_m
                       : std::max(kStripLength_m, std::ceil(length_m / kMostStrips));
  layout.strips = static_cast<int>(std::ceil(length_m / layout.strip_m - 1e-6));
  layout.y_low_m = -half_width_m - 0.02;
  layout.y_high_m = half_width_m + 0.02;
  layout.px_per_m = (MapLayout::kWidth_px - MapLayout::kMargin_px - 12) / layout.strip_m;
  return layout;
}

std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& route,
                                        double tolerance_m) {
  std::vector<Eigen::Vector2d> kept;
  Cone cone(tolerance_m);
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : route) {
    if (!is_place(p)) continue;
    if (kept.empty()) {
      kept.push_back(p);
    } else if (!cone.narrow(p - kept.back())) {
      kept.push_back(last);
      cone.reset();
      cone.narrow(p - last);
    }
    last = p;
  }
  if (!kept.empty() && last != kept.back()) kept.push_back(last);
  return kept;
}

}  // namespace furrow::ledger
