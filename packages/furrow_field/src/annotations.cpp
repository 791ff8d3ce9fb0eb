#include "furrow_field/annotations.hpp"

#include <cmath>

namespace furrow::field {
namespace {

struct Moments {
  double signed_area_px2 = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  ///< signed area times the distance to `at`
};

/// Moments about a point of the polygon, so that large coordinates cost no digits.
Moments moments_of(const Polygon& polygon, const Eigen::Vector2d& at) {
  Moments result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - at;
    const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - at;
    const double cross = a.x() * b.y() - b.x() * a.y();
    result.signed_area_px2 += 0.5 * cross;
    result.first += cross / 6.0 * (a + b);
  }
  return result;
}

}  // namespace

double polygon_area_px2(const Polygon& polygon) {
  return polygon.empty() ? 0.0 : std::abs(moments_of(polygon, polygon.front()).signed_area_px2);
}

std::optional<Eigen::Vector2d> centroid_px(const std::vector<Polygon>& polygons) {
  constexpr double kLeastArea_px2 = 1e-9;
  double area_px2 = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double points = 0.0;
  std::optional<Eigen::Vector2d> at;
  for (const Polygon& polygon : polygons) {
    if (polygon.empty()) continue;
    if (!at) at = polygon.front();
    const Moments moments = moments_of(polygon, *at);
    const double sign = moments.signed_area_px2 < 0.0 ? -1.0 : 1.0;
    area_px2 += sign * moments.signed_area_px2;
    first += sign * moments.first;
    for (const Eigen::Vector2d& point : polygon) sum += point - *at;
    points += static_cast<double>(polygon.size());
  }
  if (!at) return std::nullopt;
  if (area_px2 > kLeastArea_px2) return Eigen::Vector2d(*at + first / area_px2);
  return Eigen::Vector2d(*at + sum / points);
}

}  // namespace furrow::field
