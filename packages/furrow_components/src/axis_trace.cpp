#include "furrow_components/axis_trace.hpp"

namespace furrow::components {
namespace {

AxisPoint straight_on(const AxisPoint& from, Time time) {
  return {time, from.position_m + from.velocity_mps * (time - from.time).to_seconds(),
          from.velocity_mps};
}

}  // namespace

AxisPoint axis_at(const AxisPoint& first, const AxisPoint& second, Time time) {
  if (time <= first.time) return straight_on(first, time);
  if (time >= second.time) return straight_on(second, time);
  // Hermite's cubic over s in [0, 1], from its start: p + s (m0 + s (c + s d)).
  const double length_s = (second.time - first.time).to_seconds();
  const double s = (time - first.time).to_seconds() / length_s;
  const double rise = second.position_m - first.position_m;
  const double m0 = first.velocity_mps * length_s;
  const double m1 = second.velocity_mps * length_s;
  const double c = 3.0 * rise - 2.0 * m0 - m1;
  const double d = m0 + m1 - 2.0 * rise;
  return {time, first.position_m + s * (m0 + s * (c + s * d)),
          (m0 + s * (2.0 * c + 3.0 * s * d)) / length_s};
}

}  // namespace furrow::components
