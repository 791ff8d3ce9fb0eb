#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "experiment_options.hpp"
#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/observation_experiment.hpp"
#include "furrow_experiments/paper_figures.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

using experiments::EvaluationRow;

constexpr std::int64_t kSweepSeeds = 10;

std::string or_dash(const std::optional<double>& value, int decimals) {
  return value ? number(*value, decimals) : "-";
}

std::string with_spread(double mean, double spread, int decimals) {
  return std::isnan(spread) ? number(mean, decimals)
                            : number(mean, decimals) + "±" + number(spread, decimals);
}

std::string planner_of(const EvaluationRow& row) {
  return row.planner + "/" + row.assignment;
}

template <class Experiment>
Experiment prepared(const ExperimentOptions& options) {
  Experiment experiment;
  experiment.fields = chosen_fields(options);
  experiment.planners = chosen_planners(options);
  experiment.views = options.views;
  experiment.planner = options.planner;
  experiment.setup = options.setup;
  experiment.sampling = options.sampling;
  experiment.threads = static_cast<std::size_t>(options.threads);
  return experiment;
}

/// Runs with a progress bar; what fails is thrown.
template <class Experiment>
auto run_shown(const Experiment& experiment, const char* label) {
  ProgressBar bar(label);
  auto result = run(experiment, [&bar](double share) { bar.show(share, ""); });
  bar.finish();
  if (!result.ok()) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

/// The columns of the paper's table, and ours behind them.
void print_observation(const std::vector<EvaluationRow>& rows) {
  std::vector<std::vector<std::string>> table = {{"field", "per m2", "planner", "view", "loss %",
                                                  "travel m", "paper %", "optimum %", "p50 us",
                                                  "p99 us"}};
  for (const EvaluationRow& row : rows) {
    table.push_back({row.field, number(row.weeds_per_m2, 1), planner_of(row), row.view,
                     with_spread(row.loss_pct, row.loss_ci95, 2),
                     with_spread(row.travel_m_mean, row.travel_m_sd, 1),
                     or_dash(row.paper_loss_pct, 1), number(row.optimum_loss_pct, 2),
                     number(row.replan_p50_us, 0), number(row.replan_p99_us, 0)});
  }
  std::cout << text_table(table);
}

void print_biodiversity(const std::vector<EvaluationRow>& rows) {
  std::vector<std::vector<std::string>> table = {{"field", "per m2", "planner", "view", "scheme",
                                                  "low %", "high %", "loss %", "paper low",
                                                  "paper high"}};
  for (const EvaluationRow& row : rows) {
    table.push_back(
        {row.field, number(row.weeds_per_m2, 1), planner_of(row), row.view, row.priorities->scheme,
         number(row.priorities->treated_low_pct, 1), number(row.priorities->treated_high_pct, 1),
         with_spread(row.loss_pct, row.loss_ci95, 2), or_dash(row.priorities->paper_low_pct, 1),
         or_dash(row.priorities->paper_high_pct, 1)});
  }
  std::cout << text_table(table);
}

void evaluate_observation(const ExperimentOptions& options, bool sweeps) {
  auto experiment = prepared<experiments::ObservationExperiment>(options);
  experiment.routes = !options.html.empty();
  experiment.sweep_seeds = sweeps ? std::min(kSweepSeeds, options.sampling.seeds) : 0;
  const auto result = run_shown(experiment, "observation");
  print_observation(result.rows);
  write_results(options, to_json(experiment, result, FURROW_VERSION),
                to_html(experiment, result, FURROW_VERSION));
}

void evaluate_biodiversity(const ExperimentOptions& options) {
  const auto experiment = prepared<experiments::BiodiversityExperiment>(options);
  const auto result = run_shown(experiment, "biodiversity");
  print_biodiversity(result.rows);
  write_results(options, to_json(experiment, result, FURROW_VERSION),
                to_html(experiment, result, FURROW_VERSION));
}

}  // namespace

void add_eval_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "eval", "The experiments, the paper's figures beside ours.");

  auto observation = std::make_shared<ExperimentOptions>();
  auto sweeps = std::make_shared<std::optional<bool>>();
  CLI::App* observation_command = command->add_subcommand(
      "observation", "Loss and travel by weed density, observation model and planner.");
  add_experiment_options(observation_command, *observation);
  observation_command->add_flag("--sweeps,!--no-sweeps", *sweeps,
                                "also vary robot speed, axes, axis velocity and omega; without "
                                "being told, when there is a report to show them");
  observation_command->callback([observation, sweeps] {
    evaluate_observation(*observation, sweeps->value_or(!observation->html.empty()));
  });

  auto biodiversity = std::make_shared<ExperimentOptions>();
  biodiversity->planner.speed_mps = experiments::BiodiversityExperiment().planner.speed_mps;
  CLI::App* biodiversity_command = command->add_subcommand(
      "biodiversity", "Treated share by priority, planned with and without the priorities.");
  add_experiment_options(biodiversity_command, *biodiversity);
  biodiversity_command->callback([biodiversity] { evaluate_biodiversity(*biodiversity); });
}

}  // namespace furrow::cli
