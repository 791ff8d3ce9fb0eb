#include <iostream>
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/rendered_dataset.hpp"
#include "furrow_evaluation/vision_datasets.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/settings.hpp"
#include "furrow_vision/dataset_conversion.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

OutputFolder claim_dataset(const std::string& path, bool force) {
  return claim_folder(path, {"train.json", "validation.json", "evaluation.json"}, force, "out");
}

struct DatasetOptions {
  std::string out;
  std::string species;
  std::uint64_t seed = 1;
  std::vector<std::string> settings;
  bool force = false;
};

struct ConvertOptions {
  std::string in;
  std::string out;
  std::uint64_t seed = 1;
  vision::ConversionParameters parameters;
  bool force = false;
};

int report(const Status& done) {
  if (done.ok()) return 0;
  std::cerr << "furrow: " << done.error().message << '\n';
  return 1;
}

int render(const DatasetOptions& options) {
  const auto given = launch::given_parameters(options.settings);
  components::RenderedDatasetParameters parameters;
  ParameterLoader::load(given, parameters);
  const auto species = components::load_species(
      options.species.empty() ? launch::share_folder() / "params" / "species.yaml"
                              : std::filesystem::path(options.species));
  const OutputFolder out = claim_dataset(options.out, options.force);
  ProgressBar bar("rendering");
  const Status done = components::render_dataset(
      parameters, species, options.seed, out.path(), [&](std::int64_t count) {
        bar.show(static_cast<double>(count) / static_cast<double>(parameters.images),
                 std::to_string(count) + " images");
      });
  bar.finish();
  if (!done.ok()) return report(done);
  std::cout << out.path().string() << ": " << parameters.images
            << " rendered images in train.json, validation.json and evaluation.json\n";
  return 0;
}

int convert(const ConvertOptions& options) {
  const evaluation::EvaluationSet set = evaluation::open_evaluation_set(options.in);
  for (const std::string& note : set.notes) std::cerr << "furrow: " << note << '\n';
  const std::size_t images = set.dataset.images.size();
  const OutputFolder out = claim_dataset(options.out, options.force);
  ProgressBar bar("converting");
  const Status done = vision::convert_dataset(
      set.dataset, options.parameters, options.seed, out.path(), [&](std::size_t count) {
        bar.show(static_cast<double>(count) / static_cast<double>(images),
                 std::to_string(count) + " images");
      });
  bar.finish();
  if (!done.ok()) return report(done);
  std::cout << out.path().string() << ": " << images
            << " images in train.json, validation.json and evaluation.json\n";
  return 0;
}

void add_render_command(Command group) {
  auto options = std::make_shared<DatasetOptions>();
  Command command = group.subcommand(
      "render", "Renders annotated images as COCO, split for training, validation, evaluation.");
  command.option("out", options->out, "folder").required();
  command
      .option("--species", options->species,
              "file of the species that grow; default: params/species.yaml")
      .existing_file();
  command.option("--seed", options->seed, "seed of all random numbers").at_least(0);
  command.option("--set", options->settings, "KEY=VALUE, such as images=500");
  add_force_option(command, options->force);
  command.on_run([options] { return render(*options); });
}

void add_convert_command(Command group) {
  auto options = std::make_shared<ConvertOptions>();
  Command command = group.subcommand(
      "convert",
      "Converts CWFID, Carrot-Weed or COCO to COCO, split for training, validation, evaluation.");
  command.option("in", options->in, "folder of the data set, or a COCO file").required();
  command.option("out", options->out, "folder").required();
  vision::ConversionParameters& parameters = options->parameters;
  command
      .option("--scale", parameters.scale,
              "scale of training and validation images; evaluation images keep their size")
      .range(0.01, 10.0);
  command
      .option("--evaluation-share", parameters.evaluation_share,
              "share of all images that is for evaluation")
      .range(0.0, 0.9);
  command
      .option("--validation-share", parameters.validation_share,
              "share of the other images that is for validation")
      .range(0.0, 0.9);
  command.option("--seed", options->seed, "seed of the split").at_least(0);
  add_force_option(command, options->force);
  command.on_run([options] { return convert(*options); });
}

}  // namespace

void add_dataset_commands(Command root) {
  Command group = root.group("dataset", "Makes data sets for training.");
  add_render_command(group);
  add_convert_command(group);
}

}  // namespace furrow::cli
