#include "spray_chain.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::planning {

std::int64_t SprayChainSolver::gain(const SprayCandidates& candidates, const Spray& spray,
                                    std::int32_t last, const std::vector<std::uint16_t>& covered,
                                    const std::vector<std::int64_t>& extra) const {
  std::int64_t sum = 0;
  for (const Cover& cover : candidates.covers(spray)) {
    if (covered[cover.node] != 0) {
      continue;
    }
    bool fresh = true;
    for (std::int32_t l = last; l >= 0 && fresh;) {
      const Label& label = labels_[static_cast<std::size_t>(l)];
      if (spray.x_m - label.x_m > 2.0 * radius_m_) {
        break;
      }
      for (const Cover& before : candidates.covers(candidates.sprays()[label.spray])) {
        fresh = fresh && before.node != cover.node;
      }
      l = label.previous;
    }
    sum += fresh ? cover.score + extra[cover.node] : 0;
  }
  return sum;
}

void SprayChainSolver::follow_best(const SprayCandidates& candidates, const Start& start,
                                   const Scoring& scoring,
                                   const std::vector<std::uint16_t>& covered,
                                   const std::vector<std::int64_t>& extra, std::int64_t alone,
                                   Label& label) const {
  const Spray& spray = candidates.sprays()[label.spray];
  const double least_way_m = start.transition.needed_dx_m(0.0) - Transition::kSlack_m;
  for (auto j = static_cast<std::int32_t>(labels_.size()) - 1; j >= 0; --j) {
    const Label& from = labels_[static_cast<std::size_t>(j)];
    if (from.best_to_here + alone <= label.value) break;
    const double way_m = label.way_m - from.way_m;
    if (way_m < least_way_m || from.value + alone <= label.value) continue;
    const double dy_m = spray.y_m - from.y_m;
    if (!start.transition.feasible(way_m, dy_m)) continue;
    const std::int64_t before = from.value - scoring.travel(dy_m);
    if (before + alone <= label.value) continue;
    const std::int64_t value =
        spray.x_m - from.x_m > 2.0 * radius_m_
            ? before + alone
            : before + gain(candidates, spray, j, covered, extra) * Scoring::kScore;
    if (value > label.value) {
      label.value = value;
      label.previous = j;
    }
  }
}

std::int64_t SprayChainSolver::solve(const PreparedProblem& prepared,
                                     const SprayCandidates& candidates, const Start& start,
                                     const std::vector<std::uint16_t>& covered,
                                     const std::vector<std::int64_t>& extra,
                                     std::vector<std::uint32_t>& chain) {
  chain.clear();
  labels_.clear();
  radius_m_ = candidates.radius_m();
  const Scoring& scoring = prepared.scoring;
  std::int64_t best = 0;
  std::int32_t best_end = -1;
  for (std::uint32_t s = 0; s < candidates.sprays().size(); ++s) {
    const Spray& spray = candidates.sprays()[s];
    if (spray.x_m <= start.x_m || !start.spans(spray.y_m)) {
      continue;
    }
    const std::int64_t alone = gain(candidates, spray, -1, covered, extra) * Scoring::kScore;
    if (alone <= 0) {
      continue;
    }
    Label label{.x_m = spray.x_m, .y_m = spray.y_m, .way_m = start.way_m(spray.x_m), .spray = s};
    if (start.reaches(spray.x_m, spray.y_m)) {
      label.value = alone - scoring.travel(spray.y_m - start.y_m);
    }
    follow_best(candidates, start, scoring, covered, extra, alone, label);
    if (label.value <= 0) {
      continue;
    }
    label.best_to_here = std::max(label.value, labels_.empty() ? 0 : labels_.back().best_to_here);
    if (label.value > best) {
      best = label.value;
      best_end = static_cast<std::int32_t>(labels_.size());
    }
    labels_.push_back(label);
  }
  for (std::int32_t l = best_end; l >= 0; l = labels_[static_cast<std::size_t>(l)].previous) {
    chain.push_back(labels_[static_cast<std::size_t>(l)].spray);
  }
  std::reverse(chain.begin(), chain.end());
  return best;
}

}  // namespace furrow::planning
