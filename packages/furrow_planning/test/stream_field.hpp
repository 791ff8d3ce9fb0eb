#pragma once

#include <cstdint>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_planning/observation_view.hpp"

namespace furrow::planning {

inline PlannerParameters parameters_for(const char* view, const char* planner = "exact",
                                        const char* assignment = "joint") {
  PlannerParameters parameters;
  parameters.view = view;
  parameters.planner = planner;
  parameters.assignment = assignment;
  return parameters;
}

/// In a row along the robot, 0.12 m apart.
inline std::vector<AxisSpec> axes(int count) {
  std::vector<AxisSpec> specs;
  for (int a = 0; a < count; ++a) {
    specs.push_back({.offset_x_m = 0.06 * (count - 1) - 0.12 * a});
  }
  return specs;
}

/// Weeds at random over the width of the tool.
inline std::vector<Target> field(double per_m2, double length_m, std::uint64_t seed) {
  Random random(seed);
  std::vector<Target> targets;
  const auto count = random.poisson(per_m2 * length_m * 1.39);
  for (std::int64_t i = 0; i < count; ++i) {
    Target target;
    target.id = i;
    target.p_F = {random.uniform(0.0, length_m), random.uniform(-0.695, 0.695)};
    targets.push_back(target);
  }
  return targets;
}

}  // namespace furrow::planning
