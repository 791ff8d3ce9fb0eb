#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prepared_problem.hpp"

namespace furrow::planning {

/// The best route of one axis: a feasible chain through the given nodes with the greatest score,
/// and among those with the least travel. Dynamic programming in the order of x. A predecessor
/// further back than the axis needs for its whole span is always reachable. A running best stands
/// for all of these, so time grows with n times the targets within that distance.
class ChainSolver {
 public:
  /// `members`: indices into prepared.nodes, ascending. Writes the chain in order of travel.
  void solve(const PreparedProblem& prepared, const Start& start,
             std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain);

 private:
  struct Label {
    std::int64_t score = -1;  ///< of the best chain that ends here; -1: no chain does
    std::int64_t travel = 0;
    std::int32_t previous = -1;
  };

  /// Takes member i into the running best of far predecessors.
  void pass(std::size_t i);
  /// Labels member k by its best predecessor: the start, a far one, or one of near .. k - 1.
  void label_member(const PreparedProblem& prepared, const Start& start,
                    std::span<const std::uint32_t> members, std::size_t near, std::size_t k);

  std::vector<Label> labels_;
  std::int64_t far_score_ = -1;
  std::vector<std::uint32_t> best_far_;  ///< ends of best chains that every later node can follow
};

}  // namespace furrow::planning
