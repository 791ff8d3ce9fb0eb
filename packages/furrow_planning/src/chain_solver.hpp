#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prepared_problem.hpp"

namespace furrow::planning {

/// The best route of one axis: of all feasible chains through the given nodes one of greatest
/// score, and of those one of least travel. Dynamic programming in the order of x; moves that are
/// always in time (over a longer way than the axis needs for its whole span) are taken from a
/// running best instead of one by one, so that time grows with n times the targets within that way.
class ChainSolver {
 public:
  /// `members`: indices into prepared.nodes, ascending. Writes the chain in order of travel.
  void solve(const PreparedProblem& prepared, const Start& start,
             std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain);

 private:
  struct Label {
    std::int64_t score = -1;  ///< of the best chain that ends here; -1: none does
    std::int64_t travel = 0;
    std::int32_t previous = -1;
  };
  std::vector<Label> labels_;
  std::vector<std::uint32_t> best_far_;  ///< ends of best chains that every later node can follow
};

}  // namespace furrow::planning
