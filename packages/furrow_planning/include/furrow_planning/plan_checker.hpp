#pragma once

#include "furrow_core/result.hpp"
#include "furrow_planning/parameters.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// Checks a plan against its problem, from the definitions alone; shares no code with the planners.
/// Time O(n log n), cheap enough for every plan. Checked: order along each route, Gamma >= rho
/// between consecutive stops by the logistic function itself, the first stop within reach of the
/// axis's state, axes in service and within their span, each target treated at most once and within
/// the footprint of its stop, protection zones, one decision for each target in line with the
/// routes, the sums. The error names the axis, stop or target that fails.
class PlanChecker {
 public:
  explicit PlanChecker(const PlannerParameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] Status check(const PlanningProblem& problem, const Plan& plan);

 private:
  PlannerParameters parameters_;
  struct Seen {
    TargetId id = 0;
    std::uint32_t index = 0;
    bool treated = false;
  };
  std::vector<Seen> seen_;
  std::vector<std::uint32_t> crops_by_x_;
};

}  // namespace furrow::planning
