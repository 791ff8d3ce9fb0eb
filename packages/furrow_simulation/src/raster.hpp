#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

namespace furrow::simulation {

/// Calls span(y, x_first, x_end) for each row of samples inside a triangle, samples being at whole
/// coordinates, clipped to [0, width) x [y_first, y_end). Triangles that share an edge share no
/// sample and leave none out: a crossing is computed from the edge's upper end in both.
template <class Span>
void scan_triangle(Eigen::Vector2f a, Eigen::Vector2f b, Eigen::Vector2f c, int width, int y_first,
                   int y_end, const Span& span) {
  const auto above = [](const Eigen::Vector2f& p, const Eigen::Vector2f& q) {
    return p.y() < q.y() || (p.y() == q.y() && p.x() < q.x());
  };
  if (above(b, a)) std::swap(a, b);
  if (above(c, b)) std::swap(b, c);
  if (above(b, a)) std::swap(a, b);
  const auto limit = [](float value, int low, int high) {
    if (!(value > static_cast<float>(low))) return low;
    return value >= static_cast<float>(high) ? high : static_cast<int>(std::ceil(value));
  };
  const int top = limit(a.y(), y_first, y_end);
  const int bottom = limit(c.y(), y_first, y_end);
  const auto slope = [](const Eigen::Vector2f& p, const Eigen::Vector2f& q) {
    return q.y() > p.y() ? (q.x() - p.x()) / (q.y() - p.y()) : 0.0f;
  };
  const float slope_ac = slope(a, c);
  const float slope_ab = slope(a, b);
  const float slope_bc = slope(b, c);
  for (int y = top; y < bottom; ++y) {
    const auto fy = static_cast<float>(y);
    const float x_long = a.x() + (fy - a.y()) * slope_ac;
    const float x_short =
        fy < b.y() ? a.x() + (fy - a.y()) * slope_ab : b.x() + (fy - b.y()) * slope_bc;
    const int first = limit(std::min(x_long, x_short), 0, width);
    const int end = limit(std::max(x_long, x_short), 0, width);
    if (first < end) span(y, first, end);
  }
}

}  // namespace furrow::simulation
