#include <iostream>
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "furrow_evaluation/vision_experiment.hpp"
#include "output_options.hpp"
#include "vision_options.hpp"

namespace furrow::cli {
namespace {

struct EvalVisionOptions {
  VisionOptions vision;
  evaluation::VisionExperiment experiment;
  std::string species;
  ResultOptions results;
};

int evaluate_vision(const EvalVisionOptions& options) {
  ResultFiles files(options.results);
  evaluation::VisionExperiment experiment = options.experiment;
  experiment.detectors = options.vision.choices;
  experiment.resolution_mm_per_px = options.vision.resolution_mm_per_px;
  experiment.species_file = options.species;
  experiment.pictures = files.wants_html();
  StagedProgress progress;
  const evaluation::VisionReport report =
      run(experiment, [&](const std::string& stage, double share) { progress.show(stage, share); });
  progress.finish();
  for (const std::string& note : report.notes) std::cerr << "furrow: " << note << '\n';
  std::cout << to_table(report);
  files.write_json(to_json(report));
  files.write_html(to_html(report));
  return 0;
}

}  // namespace

void add_eval_vision_command(Command root) {
  auto options = std::make_shared<EvalVisionOptions>();
  evaluation::VisionExperiment& experiment = options->experiment;
  Command command = eval_group(root).subcommand(
      "vision", "IoU, average precision, stem and area errors of the detectors.");
  command.option("--dataset", experiment.datasets,
                 "'rendered', a folder of CWFID or Carrot-Weed, or COCO (evaluation.json)");
  add_vision_options(command, options->vision);
  command.option("--images", experiment.images, "images of the rendered set").range(1, 100'000);
  command.option("--limit", experiment.limit, "images of each set; 0: all").at_least(0);
  command.option("--seed", experiment.seed, "seed of the rendered set");
  command
      .option("--species", options->species,
              "species of the rendered set; default: params/species_evaluation.yaml")
      .existing_file();
  add_result_options(command, options->results, true);
  command.on_run([options] { return evaluate_vision(*options); });
}

}  // namespace furrow::cli
