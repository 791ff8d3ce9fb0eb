#pragma once

#include <cstdint>
#include <vector>

#include "prepared_problem.hpp"
#include "spray_candidates.hpp"

namespace furrow::planning {

/// A chain of sprays of one axis that is worth the most, given what the other axes treat. Dynamic
/// programming with one label for each placement; a stem that several sprays of a chain reach
/// counts once, by walking back along the label's own chain, so that a label's value is true. (One
/// label for each placement makes this a heuristic where such sprays meet, exact elsewhere.)
class SprayChainSolver {
 public:
  /// `covered[node]`: how many sprays of other axes treat it; `extra[node]`: a score on top of the
  /// one that its cover has. Writes indices into sprays, in order
  /// of travel, and returns the value: score * Scoring::kScore - travel.
  std::int64_t solve(const PreparedProblem& prepared, const SprayCandidates& candidates,
                     const Start& start, const std::vector<std::uint16_t>& covered,
                     const std::vector<std::int64_t>& extra, std::vector<std::uint32_t>& chain);

 private:
  struct Label {
    double x_m = 0.0;
    double y_m = 0.0;
    double way_m = 0.0;      ///< see Start
    std::int64_t value = 0;  ///< 0: no chain ends here
    std::int64_t best_to_here = 0;
    std::uint32_t spray = 0;
    std::int32_t previous = -1;
  };
  /// What the spray adds to a chain that ends in `last`.
  [[nodiscard]] std::int64_t gain(const SprayCandidates& candidates, const Spray& spray,
                                  std::int32_t last, const std::vector<std::uint16_t>& covered,
                                  const std::vector<std::int64_t>& extra) const;

  double radius_m_ = 0.0;
  std::vector<Label> labels_;
};

}  // namespace furrow::planning
