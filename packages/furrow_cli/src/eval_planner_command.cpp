#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "commands.hpp"
#include "console.hpp"
#include "experiment_options.hpp"
#include "furrow_core/version.hpp"
#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/observation_experiment.hpp"

namespace furrow::cli {
namespace {

constexpr std::int64_t kSweepSeeds = 10;

template <class Experiment>
Experiment experiment_of(const ExperimentOptions& options) {
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

template <class Experiment>
int evaluate_planners(const Experiment& experiment, const char* label, ResultFiles& files) {
  ProgressBar bar(label);
  const auto result = run(experiment, [&bar](double share) { bar.show(share, ""); });
  bar.finish();
  if (!result.ok()) throw std::runtime_error(result.error().message);
  std::cout << to_table(*result);
  files.write_json(to_json(experiment, *result, version()));
  if (files.wants_html()) files.write_html(to_html(experiment, *result, version()));
  return 0;
}

int evaluate_observation(const ExperimentOptions& options, std::optional<bool> sweeps) {
  ResultFiles files(options.results);
  auto experiment = experiment_of<experiments::ObservationExperiment>(options);
  experiment.routes = files.wants_html();
  experiment.sweep_seeds =
      sweeps.value_or(files.wants_html()) ? std::min(kSweepSeeds, options.sampling.seeds) : 0;
  return evaluate_planners(experiment, "observation", files);
}

int evaluate_biodiversity(const ExperimentOptions& options) {
  ResultFiles files(options.results);
  return evaluate_planners(experiment_of<experiments::BiodiversityExperiment>(options),
                           "biodiversity", files);
}

}  // namespace

void add_eval_planner_commands(Command root) {
  auto observation = std::make_shared<ExperimentOptions>();
  auto sweeps = std::make_shared<std::optional<bool>>();
  Command observation_command = eval_group(root).subcommand(
      "observation", "Loss and travel by weed density, observation model and planner.");
  add_experiment_options(observation_command, *observation);
  observation_command.flag("--sweeps,!--no-sweeps", *sweeps,
                           "also vary robot speed, axes, axis velocity and omega; default: "
                           "with --html");
  observation_command.on_run([observation, sweeps, observation_command] {
    apply_quick(observation_command, *observation);
    return evaluate_observation(*observation, *sweeps);
  });

  auto biodiversity = std::make_shared<ExperimentOptions>();
  biodiversity->planner.speed_mps = experiments::BiodiversityExperiment().planner.speed_mps;
  Command biodiversity_command = eval_group(root).subcommand(
      "biodiversity", "Treated share by priority, planned with and without priorities.");
  add_experiment_options(biodiversity_command, *biodiversity);
  biodiversity_command.on_run([biodiversity, biodiversity_command] {
    apply_quick(biodiversity_command, *biodiversity);
    return evaluate_biodiversity(*biodiversity);
  });
}

}  // namespace furrow::cli
