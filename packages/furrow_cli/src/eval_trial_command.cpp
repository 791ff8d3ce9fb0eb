#include <iostream>
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "furrow_core/version.hpp"
#include "furrow_evaluation/trial_experiment.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

struct TrialOptions {
  evaluation::TrialExperiment experiment;
  std::string out = "out/trial";
  bool quick = false;
  bool constant_speed = false;
  ResultOptions results;
};

int evaluate_trial(const TrialOptions& options) {
  const OutputFolder folder =
      claim_folder(options.out, {"trial.html", "fields"}, options.results.force);
  ResultOptions results = options.results;
  if (results.html.empty()) results.html = (folder.path() / "trial.html").string();
  ResultFiles files(results);
  evaluation::TrialExperiment experiment = options.experiment;
  experiment.folder = folder.path();
  experiment.governed = !options.constant_speed;
  ProgressBar bar("trial");
  const evaluation::TrialResult result =
      run(experiment, [&bar](double share) { bar.show(share, ""); });
  bar.finish();
  std::cout << to_table(result);
  files.write_json(to_json(experiment, result, version()));
  files.write_html(to_html(experiment, result, version()));
  return 0;
}

}  // namespace

void add_eval_trial_command(Command root) {
  Command command = eval_group(root).subcommand(
      "trial",
      "The paper's field trial in closed loop: weed-only and crop-weed regions from low to high "
      "density.");
  auto options = std::make_shared<TrialOptions>();
  evaluation::TrialExperiment& experiment = options->experiment;
  command.option("--graph", experiment.graph, "graph file, or the name of a shipped graph");
  command.option("--length", experiment.length_m, "length of each of the six stretches, m")
      .range(1.0, 1000.0);
  command.option("--seed", experiment.seed, "seed of all random numbers");
  command.option("--set", experiment.settings, "COMPONENT.KEY=VALUE overrides a parameter");
  command.option("--threads", experiment.threads, "worker threads").range(1, 256);
  command.flag("--constant-speed", options->constant_speed,
               "the robot keeps its speed; default: it follows the planner's speed requests");
  command.flag("--quick", options->quick, "stretches of 3 m");
  command.option("--out", options->out,
                 "folder for fields and reports; numbered when it holds earlier ones");
  add_result_options(command, options->results, true);
  command.footer("The report goes to trial.html in --out unless --html is given.");
  command.on_run([options, command] {
    constexpr double kQuick_m = 3.0;
    if (options->quick && !command.given("--length")) options->experiment.length_m = kQuick_m;
    return evaluate_trial(*options);
  });
}

}  // namespace furrow::cli
