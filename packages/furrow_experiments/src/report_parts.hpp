#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"

namespace furrow::experiments {

/// "exact/joint".
[[nodiscard]] std::string planner_name(const EvaluationRow& row);
/// The same in every chart; "" for planners that have no colour of their own.
[[nodiscard]] std::string planner_color(std::string_view planner);
inline constexpr std::string_view kPaperColor = "#5c5c5c";
inline constexpr std::string_view kOptimumColor = "#8a6d3b";

/// "20 fields of 20 m x 1.39 m each, weeds only, poisson; 4 axes at 5 m/s, robot at 0.5 m/s,
/// velocity kinematics".
[[nodiscard]] std::string conditions(const planning::PlannerParameters& planner,
                                     const SetupParameters& setup,
                                     const SamplingParameters& sampling,
                                     const std::vector<FieldCase>& fields);

/// Every parameter and its value, then seed and version.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> provenance_facts(
    const planning::PlannerParameters& planner, const SetupParameters& setup,
    const SamplingParameters& sampling, std::string_view version);

/// "12.3", or "-" when there is none.
[[nodiscard]] std::string cell(const std::optional<double>& value, int decimals = 1);

/// "cn20_like, 3.1 weeds/m2".
[[nodiscard]] std::string field_title(const EvaluationRow& row);

/// Field names in the order in which rows have them.
[[nodiscard]] std::vector<std::string> field_names(const std::vector<EvaluationRow>& rows);

/// Planner names of `rows` that have a colour, in the order in which rows have them.
[[nodiscard]] std::vector<std::string> main_planners(const std::vector<EvaluationRow>& rows);

}  // namespace furrow::experiments
