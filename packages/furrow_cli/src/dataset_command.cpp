#include <iostream>

#include "command.hpp"
#include "console.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/rendered_dataset.hpp"
#include "furrow_graph/parameter_file.hpp"
#include "furrow_vision/dataset_conversion.hpp"
#include "share.hpp"
#include "vision_datasets.hpp"

namespace furrow::cli {
namespace {

struct DatasetOptions {
  std::string out;
  std::string species;
  std::uint64_t seed = 1;
  std::vector<std::string> settings;
};

struct ConvertOptions {
  std::string in;
  std::string out;
  std::uint64_t seed = 1;
  vision::ConversionParameters parameters;
};

int report(const Status& done) {
  if (done.ok()) return 0;
  std::cerr << "furrow: " << done.error().message << '\n';
  return 1;
}

int render(const DatasetOptions& options) {
  std::vector<GivenParameter> given;
  for (const std::string& setting : options.settings) {
    const auto equals = setting.find('=');
    const SourceLocation where{"--set " + setting, 0};
    if (equals == std::string::npos) throw ConfigError(where, "", "is not KEY=VALUE");
    given.push_back({setting.substr(0, equals),
                     graph::parse_parameter_value(setting.substr(equals + 1)), where});
  }
  components::RenderedDatasetParameters parameters;
  ParameterLoader::load(given, parameters);
  const auto species =
      components::load_species(options.species.empty() ? share_folder() / "params" / "species.yaml"
                                                       : std::filesystem::path(options.species));
  ProgressBar bar("rendering");
  const Status done = components::render_dataset(
      parameters, species, options.seed, options.out, [&](std::int64_t count) {
        bar.show(static_cast<double>(count) / static_cast<double>(parameters.images),
                 std::to_string(count) + " images");
      });
  bar.finish();
  if (!done.ok()) return report(done);
  std::cout << options.out << ": " << parameters.images
            << " rendered images in train.json, validation.json and evaluation.json\n";
  return 0;
}

int convert(const ConvertOptions& options) {
  const EvaluationSet set = open_evaluation_set(options.in);
  const std::size_t images = set.dataset.images.size();
  ProgressBar bar("converting");
  const Status done = vision::convert_dataset(
      set.dataset, options.parameters, options.seed, options.out, [&](std::size_t count) {
        bar.show(static_cast<double>(count) / static_cast<double>(images),
                 std::to_string(count) + " images");
      });
  bar.finish();
  if (!done.ok()) return report(done);
  std::cout << options.out << ": " << images
            << " images in train.json, validation.json and evaluation.json\n";
  return 0;
}

void add_render_command(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<DatasetOptions>();
  CLI::App* command = parent.add_subcommand(
      "render", "Renders annotated images as COCO, split for training, validation and evaluation.");
  command->add_option("out", options->out, "folder")->required();
  command
      ->add_option("--species", options->species,
                   "file of the species that grow, in place of params/species.yaml")
      ->check(CLI::ExistingFile);
  command->add_option("--seed", options->seed, "of everything that is drawn")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--set", options->settings, "KEY=VALUE, such as images=500")->take_all();
  command->callback([options, &exit_code] { exit_code = render(*options); });
}

void add_convert_command(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = parent.add_subcommand(
      "convert",
      "CWFID, Carrot-Weed or COCO as COCO, split for training, validation and evaluation.");
  command->add_option("in", options->in, "folder of the data set, or a COCO file")->required();
  command->add_option("out", options->out, "folder")->required();
  vision::ConversionParameters& parameters = options->parameters;
  command
      ->add_option("--scale", parameters.scale,
                   "of training and validation images; those for evaluation stay as they are")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  command->add_option("--evaluation-share", parameters.evaluation_share, "of all images")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_option("--validation-share", parameters.validation_share, "of the other images")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of which image goes where")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = convert(*options); });
}

}  // namespace

void add_dataset_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("dataset", "Makes data sets for training.");
  command->require_subcommand(1);
  add_render_command(*command, exit_code);
  add_convert_command(*command, exit_code);
}

}  // namespace furrow::cli
