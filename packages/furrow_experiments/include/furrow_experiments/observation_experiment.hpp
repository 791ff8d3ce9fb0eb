#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"
#include "furrow_experiments/route_figure.hpp"
#include "furrow_experiments/sweep.hpp"

namespace furrow::experiments {

/// The paper's first table, for every planner asked for: loss and travel by density and view.
struct ObservationExperiment {
  std::vector<FieldCase> fields = paper_field_cases();
  std::vector<PlannerChoice> planners = all_planner_choices();
  std::vector<std::string> views = {"segment", "rolling"};
  planning::PlannerParameters planner;  ///< planner, assignment, view are set by the lists
  SetupParameters setup;
  SamplingParameters sampling;
  std::size_t threads = 0;
  std::int64_t sweep_seeds = 0;  ///< 0: no sweeps
  bool routes = false;           ///< record the example routes
};

struct ObservationResult {
  std::vector<EvaluationRow> rows;  ///< by field, planner, view
  std::vector<SweepPoint> sweeps;
  std::int64_t sweep_seeds = 0;
  std::vector<RouteExample> routes;
};

/// Errors and exceptions: as drive_all.
[[nodiscard]] Result<ObservationResult> run(const ObservationExperiment& experiment,
                                            const Progress& progress = {});

/// For a terminal.
[[nodiscard]] std::string to_table(const ObservationResult& result);
/// One object: rows with the keys of `furrow eval observation`, sweeps, seed, parameters, version.
[[nodiscard]] std::string to_json(const ObservationExperiment& experiment,
                                  const ObservationResult& result, std::string_view version);
/// A self-contained page.
[[nodiscard]] std::string to_html(const ObservationExperiment& experiment,
                                  const ObservationResult& result, std::string_view version);

}  // namespace furrow::experiments
