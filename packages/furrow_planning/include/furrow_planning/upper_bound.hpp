#pragma once

#include <cstdint>

#include "furrow_core/result.hpp"
#include "furrow_planning/parameters.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

struct BoundEffort {
  double cell_m = 0.003;          ///< of the grid of placements; smaller is tighter and slower
  std::int64_t iterations = 100;  ///< of the subgradient method
};

/// Upper bound on the weight of any plan, wherever its sprays are centred. It bounds the optimality
/// gap of the footprint planner. For evaluation only: time grows with
/// iterations * targets / cell_m^2. Error: as RoutePlanner::plan.
///
/// Relaxations:
/// - Placements become cells of a grid. A cell treats every stem within the radius of any of its
///   points, and allows every move that any of its points allows.
/// - Trapezoid moves become velocity moves.
/// - "Each stem counts once" is priced instead of enforced (Lagrange multipliers, subgradient
///   method: Held and Karp 1971). Each axis then takes its best chain.
///
/// A chain that passes a stem several times collects its price each time. So the bound is loose
/// where axes are saturated. Where they are not, it is the weight of all targets and nearly tight.
[[nodiscard]] Result<double> footprint_weight_bound(const PlanningProblem& problem,
                                                    const PlannerParameters& parameters,
                                                    const BoundEffort& effort = {});

}  // namespace furrow::planning
