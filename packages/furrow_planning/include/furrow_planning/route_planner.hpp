#pragma once

#include <memory>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_planning/parameters.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// Plans a route for each axis. Keeps its working memory between calls: planning again for a
/// problem of like size does not allocate. Not thread-safe; the same problem gives the same plan
/// on every machine and with any number of threads.
class RoutePlanner {
 public:
  virtual ~RoutePlanner() = default;

  /// Fills `plan`. Targets that cannot or should not be treated are decisions in the plan, not
  /// errors. Errors leave the plan empty: no axes, a different number of states and axes, a
  /// non-finite number of robot or axes, a speed <= 0, more targets than max_targets.
  [[nodiscard]] virtual Status plan(const PlanningProblem& problem, Plan& plan) = 0;
  [[nodiscard]] virtual std::string_view name() const = 0;
};

/// By `parameters.planner` and `parameters.assignment`:
///   greedy, notsp, permutation, exact  with distance, static, dynamic;
///   greedy, exact, footprint           with joint.
/// Throws ConfigError for other combinations and values out of range.
[[nodiscard]] std::unique_ptr<RoutePlanner> make_route_planner(const PlannerParameters& parameters);

}  // namespace furrow::planning
