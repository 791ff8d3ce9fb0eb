#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"

namespace furrow::experiments {

/// The paper's second table: at 1.0 m/s, one weed of high priority (weight 1.0) to ten of low
/// priority (0.1), planned with these weights ("biodiversity") and with all weights equal
/// ("plain").
struct BiodiversityExperiment {
  BiodiversityExperiment() { planner.speed_mps = 1.0; }

  std::vector<FieldCase> fields = paper_field_cases();
  std::vector<PlannerChoice> planners = all_planner_choices();
  std::vector<std::string> views = {"segment", "rolling"};
  planning::PlannerParameters planner;
  SetupParameters setup;
  SamplingParameters sampling;
  std::size_t threads = 0;
};

struct BiodiversityResult {
  std::vector<EvaluationRow> rows;  ///< by field, planner, view, scheme (plain first)
};

/// Errors and exceptions: as drive_all.
[[nodiscard]] Result<BiodiversityResult> run(const BiodiversityExperiment& experiment,
                                             const Progress& progress = {});

/// For a terminal.
[[nodiscard]] std::string to_table(const BiodiversityResult& result);
/// One object: rows with the keys of `furrow eval biodiversity`, seed, parameters, version.
[[nodiscard]] std::string to_json(const BiodiversityExperiment& experiment,
                                  const BiodiversityResult& result, std::string_view version);
/// A self-contained page.
[[nodiscard]] std::string to_html(const BiodiversityExperiment& experiment,
                                  const BiodiversityResult& result, std::string_view version);

}  // namespace furrow::experiments
