#include <iostream>
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "furrow_core/version.hpp"
#include "furrow_evaluation/tracking_experiment.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

struct TrackingOptions {
  evaluation::TrackingExperiment experiment;
  bool quick = false;
  ResultOptions results;
};

int evaluate_tracking(const TrackingOptions& options) {
  ResultFiles files(options.results);
  evaluation::TrackingExperiment experiment = options.experiment;
  experiment.replay = evaluation::shipped_replay_options();
  ProgressBar bar("tracking");
  const auto rows = run(experiment, [&bar](double share) { bar.show(share, ""); });
  bar.finish();
  std::cout << to_table(rows);
  files.write_json(to_json(experiment, rows, version()));
  files.write_html(to_html(experiment, rows, version()));
  return 0;
}

}  // namespace

void add_eval_tracking_command(Command root) {
  Command command = eval_group(root).subcommand(
      "tracking",
      "Counts, identities and positions of plants by association and localization, on rendered "
      "rows.");
  auto options = std::make_shared<TrackingOptions>();
  evaluation::TrackingExperiment& experiment = options->experiment;
  command.option("--field", experiment.fields, "shipped presets, or fields as files");
  command.option("--seeds", experiment.seeds, "generated fields of each preset").range(1, 1000);
  command.option("--seed", experiment.first_seed, "seed of the first field");
  command.option("--length", experiment.length_m, "length of each row, m").range(1.0, 1000.0);
  command.option("--set", experiment.settings,
                 "COMPONENT.KEY=VALUE overrides a parameter of robot, camera or perception");
  command.option("--threads", experiment.threads, "worker threads").range(1, 256);
  command.flag("--quick", options->quick, "three fields of 4 m");
  add_result_options(command, options->results, true);
  command.on_run([options, command] {
    if (options->quick && !command.given("--field")) {
      options->experiment.fields = {"cn20_like", "sb20_s1_like", "sb21_s1_like"};
    }
    if (options->quick && !command.given("--length")) options->experiment.length_m = 4.0;
    return evaluate_tracking(*options);
  });
}

}  // namespace furrow::cli
