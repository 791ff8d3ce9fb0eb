#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::experiments {

/// A planner with the way in which it divides the targets among the axes.
struct PlannerChoice {
  std::string planner;
  std::string assignment;
  bool operator==(const PlannerChoice&) const = default;
};

/// "exact/joint".
[[nodiscard]] std::string to_string(const PlannerChoice& choice);
/// Of "exact/joint"; a name that has only one assignment may stand alone ("footprint"). Error: no
/// such pair, with those that there are.
[[nodiscard]] Result<PlannerChoice> planner_choice_from(std::string_view text);

/// Every pair that furrow_planning knows, from the plainest to the best.
[[nodiscard]] const std::vector<PlannerChoice>& all_planner_choices();
/// Those to compare side by side: the paper's, greedy, exact and footprint.
[[nodiscard]] std::vector<PlannerChoice> main_planner_choices();

}  // namespace furrow::experiments
