#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"

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
  std::string json;
  std::string html;
};

void add_experiment_options(CLI::App* command, ExperimentOptions& options);

/// Throws ConfigError for planners and fields that are not there.
[[nodiscard]] std::vector<experiments::PlannerChoice> chosen_planners(
    const ExperimentOptions& options);
[[nodiscard]] std::vector<experiments::FieldCase> chosen_fields(const ExperimentOptions& options);

/// Writes the files that were asked for and says so. Throws where that fails.
void write_results(const ExperimentOptions& options, const std::string& json,
                   const std::string& html);

}  // namespace furrow::cli
