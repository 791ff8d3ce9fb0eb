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

/// A weight that no plan can exceed, wherever its sprays are centred: so that the gap of the
/// footprint planner is known. Placements are relaxed to the cells of a grid (a cell treats every
/// stem within the radius of any of its points, and allows every move that any of its points
/// allows; trapezoid moves to velocity moves). That each stem counts once is priced instead of
/// enforced (Lagrange multipliers, subgradient method: Held and Karp 1971), and each axis takes the
/// chain that is then worth most. A stem that a chain passes several times is paid each time less
/// its price, which is why the bound lies far above where axes are saturated, and at everything
/// where they are not; there the planner comes close to it. For evaluation, not for the replan
/// path: time grows with iterations * targets / cell_m^2. Error: as RoutePlanner::plan.
[[nodiscard]] Result<double> footprint_weight_bound(const PlanningProblem& problem,
                                                    const PlannerParameters& parameters,
                                                    const BoundEffort& effort = {});

}  // namespace furrow::planning
