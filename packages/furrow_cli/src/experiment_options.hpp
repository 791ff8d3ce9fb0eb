#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"
#include "output_options.hpp"

namespace furrow::cli {

/// What the experiments on planners have in common on the command line.
struct ExperimentOptions {
  experiments::SamplingParameters sampling;
  experiments::SetupParameters setup;
  planning::PlannerParameters planner;
  std::vector<std::string> planners;
  std::vector<std::string> views = {"segment", "rolling"};
  std::vector<std::string> fields;
  std::int64_t threads = 0;
  bool quick = false;
  ResultOptions results;
};

void add_experiment_options(Command command, ExperimentOptions& options);

/// With --quick, fewer and shorter fields and the main planners, where the user gave none. Call it
/// when the command runs.
void apply_quick(Command command, ExperimentOptions& options);

/// Throws ConfigError for planners and fields that do not exist.
[[nodiscard]] std::vector<experiments::PlannerChoice> chosen_planners(
    const ExperimentOptions& options);
[[nodiscard]] std::vector<experiments::FieldCase> chosen_fields(const ExperimentOptions& options);

}  // namespace furrow::cli
