#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "furrow_planning/parameters.hpp"
#include "prepared_problem.hpp"

namespace furrow::planning {

/// Finds a route of one axis through the nodes assigned to it.
class AxisRouter {
 public:
  virtual ~AxisRouter() = default;
  /// `members`: indices into prepared.nodes, ascending. Writes the chain in order of travel.
  virtual void route(const PreparedProblem& prepared, const Start& start,
                     std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain) = 0;
};

/// Takes the next reachable target; among equal ones, the one with less travel.
[[nodiscard]] std::unique_ptr<AxisRouter> make_greedy_router();
/// nOTSP (named by Ahmadi et al. 2024; this reading is ours): at each step, find the best open
/// route over the n nearest reachable targets and take its first leg.
[[nodiscard]] std::unique_ptr<AxisRouter> make_notsp_router(std::size_t n);
/// Takes block after block of n targets and, of all sequences of a block with C > 0 (all
/// Gamma >= rho), the one with the greatest K, then the greatest C. See Ahmadi et al. 2024,
/// eq. trajectoryProb and trajectoryCost.
[[nodiscard]] std::unique_ptr<AxisRouter> make_permutation_router(std::size_t n, double omega);
[[nodiscard]] std::unique_ptr<AxisRouter> make_exact_router();

}  // namespace furrow::planning
