#include "furrow_actuation/as_applied.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace furrow::actuation {
namespace {

struct Disc {
  Eigen::Vector2d p;
  double radius;
};

constexpr double kCell_m = 0.0025;

bool contains(const Disc& disc, const Eigen::Vector2d& p) {
  return (p - disc.p).squaredNorm() <= disc.radius * disc.radius;
}

/// Calls `sample` with the centre of each cell whose centre lies in the disc.
template <class Sample>
void each_cell(const Disc& disc, Sample sample) {
  const auto low = ((disc.p.array() - disc.radius) / kCell_m).floor();
  const auto high = ((disc.p.array() + disc.radius) / kCell_m).ceil();
  for (double i = low.x(); i <= high.x(); ++i) {
    for (double k = low.y(); k <= high.y(); ++k) {
      const Eigen::Vector2d p((i + 0.5) * kCell_m, (k + 0.5) * kCell_m);
      if (contains(disc, p)) sample(p);
    }
  }
}

}  // namespace

double sprayed_area_m2(std::span<const Application> applications) {
  std::vector<Disc> discs;
  double greatest_m = 0.0;
  for (const Application& a : applications) {
    constexpr double kLargest_m = 1.0;
    if (!a.p_F.allFinite() || !(a.radius_m > 0.0 && a.radius_m < kLargest_m)) continue;
    discs.push_back({a.p_F, a.radius_m});
    greatest_m = std::max(greatest_m, a.radius_m);
  }
  std::ranges::sort(discs, {}, [](const Disc& disc) { return disc.p.x(); });
  std::int64_t cells = 0;
  std::size_t first = 0;
  std::vector<Disc> before;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    while (discs[i].p.x() - discs[first].p.x() > 2.0 * greatest_m) ++first;
    before.clear();
    for (std::size_t k = first; k < i; ++k) {
      if ((discs[k].p - discs[i].p).norm() < discs[k].radius + discs[i].radius) {
        before.push_back(discs[k]);
      }
    }
    each_cell(discs[i], [&](const Eigen::Vector2d& p) {
      const bool counted =
          std::ranges::any_of(before, [&](const Disc& disc) { return contains(disc, p); });
      if (!counted) ++cells;
    });
  }
  return static_cast<double>(cells) * kCell_m * kCell_m;
}

std::string as_applied_geojson(
    std::span<const Application> applications,
    const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& to_lon_lat_deg) {
  // Seven decimals of a degree are 1 cm, nine 0.1 mm.
  const auto degrees = [](double value) { return std::round(value * 1e9) / 1e9; };
  const auto rounded = [](double value, double step) { return std::round(value / step) * step; };
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  for (const Application& a : applications) {
    const Eigen::Vector2d lon_lat_deg = to_lon_lat_deg(a.p_F);
    if (!lon_lat_deg.allFinite()) continue;
    features.push_back({{"type", "Feature"},
                        {"geometry",
                         {{"type", "Point"},
                          {"coordinates", {degrees(lon_lat_deg.x()), degrees(lon_lat_deg.y())}}}},
                        {"properties",
                         {{"axis", a.axis},
                          {"time_s", rounded(a.time.to_seconds(), 1e-4)},
                          {"open_s", rounded(a.open_s, 1e-5)},
                          {"volume_ml", rounded(a.volume_ml, 1e-5)},
                          {"radius_m", a.radius_m},
                          {"x_m", rounded(a.p_F.x(), 1e-5)},
                          {"y_m", rounded(a.p_F.y(), 1e-5)},
                          {"track_ids", a.track_ids}}}});
  }
  const nlohmann::ordered_json collection = {{"type", "FeatureCollection"},
                                             {"features", std::move(features)}};
  return collection.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace furrow::actuation
