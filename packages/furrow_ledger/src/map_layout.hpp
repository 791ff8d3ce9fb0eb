#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {

/// The stretch of field that is drawn, cut into strips.
struct MapLayout {
  static constexpr double kWidth_px = 1200.0;
  static constexpr double kMargin_px = 44.0;
  static constexpr double kGap_px = 40.0;  ///< between strips, with the x axis in it

  double from_m = 0.0;
  double to_m = 1.0;
  double strip_m = 1.0;
  double y_low_m = -0.5;
  double y_high_m = 0.5;
  int strips = 1;
  double px_per_m = 1.0;
  double top_px = 0.0;

  [[nodiscard]] double strip_height_px() const { return (y_high_m - y_low_m) * px_per_m; }
  [[nodiscard]] double strip_top_px(int strip) const {
    return top_px + strip * (strip_height_px() + kGap_px);
  }
  [[nodiscard]] double x_px(int strip, double x_m) const {
    return kMargin_px + (x_m - from_m - strip * strip_m) * px_per_m;
  }
  [[nodiscard]] double y_px(int strip, double y_m) const {
    return strip_top_px(strip) + (y_high_m - y_m) * px_per_m;
  }
  /// The strips that show something from `low_m` to `high_m`: first, last; first > last for none.
  [[nodiscard]] std::pair<int, int> strips_of(double low_m, double high_m) const {
    if (!(high_m >= from_m) || !(low_m <= to_m)) return {1, 0};
    const auto index = [&](double x_m) {
      return static_cast<int>(
          std::clamp(std::floor((x_m - from_m) / strip_m), 0.0, static_cast<double>(strips - 1)));
    };
    return {index(low_m), index(high_m)};
  }
};

/// Size and strips from the ledger's field, or from its plants where the field gives none.
[[nodiscard]] MapLayout make_map_layout(const Ledger& ledger, double max_length_m);

/// Finite and not absurdly far: what can be drawn.
[[nodiscard]] bool is_place(const Eigen::Vector2d& p);

/// The points of a route without which its line would move by more than the tolerance; points that
/// cannot be drawn are left out.
[[nodiscard]] std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& route,
                                                      double tolerance_m);

}  // namespace furrow::ledger
