#pragma once

#include <cstdint>
#include <vector>

#include "prepared_problem.hpp"
#include "spray_candidates.hpp"

namespace furrow::planning {

/// The best chain of sprays of one axis, given the targets that the other axes treat. Dynamic
/// programming with one label for each placement. A stem reached by several sprays of a chain
/// counts once: the solver walks back along the label's own chain. With one label for each
/// placement this is a heuristic where such sprays meet, and exact elsewhere.
class SprayChainSolver {
 public:
  /// `covered[node]`: number of sprays of other axes that treat it. `extra[node]`: added to the
  /// score of its cover. Writes indices into sprays, in order of travel. Returns the value:
  /// score * Scoring::kScore - travel.
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
  /// Score that the spray adds to a chain that ends in `last`.
  [[nodiscard]] std::int64_t gain(const SprayCandidates& candidates, const Spray& spray,
                                  std::int32_t last, const std::vector<std::uint16_t>& covered,
                                  const std::vector<std::int64_t>& extra) const;

  /// Gives the label its best predecessor. `alone`: gain of its spray after no other.
  void follow_best(const SprayCandidates& candidates, const Start& start, const Scoring& scoring,
                   const std::vector<std::uint16_t>& covered,
                   const std::vector<std::int64_t>& extra, std::int64_t alone, Label& label) const;

  double radius_m_ = 0.0;
  std::vector<Label> labels_;
};

}  // namespace furrow::planning
