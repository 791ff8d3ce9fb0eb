#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_planning/observation_view.hpp"

namespace furrow::planning::bench {

/// A homogeneous Poisson field of weeds, by x.
inline std::vector<Target> poisson_field(double per_m2, double length_m, double width_m,
                                         std::uint64_t seed) {
  Random random(seed, "field");
  std::vector<Target> targets;
  const auto count = random.poisson(per_m2 * length_m * width_m);
  for (std::int64_t i = 0; i < count; ++i) {
    Target target;
    target.p_F = {random.uniform(0.0, length_m), random.uniform(-0.5 * width_m, 0.5 * width_m)};
    targets.push_back(target);
  }
  std::sort(targets.begin(), targets.end(),
            [](const Target& a, const Target& b) { return a.p_F.x() < b.p_F.x(); });
  for (std::size_t i = 0; i < targets.size(); ++i) {
    targets[i].id = static_cast<TargetId>(i);
  }
  return targets;
}

/// The published tool: four axes of 1.39 m, 0.12 m apart along the travel.
inline std::vector<AxisSpec> four_axes() {
  std::vector<AxisSpec> axes;
  for (const double x : {0.18, 0.06, -0.06, -0.18}) {
    axes.push_back({.offset_x_m = x});
  }
  return axes;
}

}  // namespace furrow::planning::bench
