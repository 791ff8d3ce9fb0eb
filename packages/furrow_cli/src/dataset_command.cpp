#include <iostream>

#include "command.hpp"
#include "console.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/rendered_dataset.hpp"
#include "furrow_graph/parameter_file.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

struct DatasetOptions {
  std::string out;
  std::uint64_t seed = 1;
  std::vector<std::string> settings;
};

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
  const auto species = components::load_species(share_folder() / "params" / "species.yaml");
  ProgressBar bar("rendering");
  const Status done = components::render_dataset(
      parameters, species, options.seed, options.out, [&](std::int64_t count) {
        bar.show(static_cast<double>(count) / static_cast<double>(parameters.images),
                 std::to_string(count) + " images");
      });
  bar.finish();
  if (!done.ok()) {
    std::cerr << "furrow: " << done.error().message << '\n';
    return 1;
  }
  std::cout << options.out << ": " << parameters.images
            << " rendered images in train.json, validation.json and evaluation.json\n";
  return 0;
}

}  // namespace

void add_dataset_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("dataset", "Makes data sets for training.");
  command->require_subcommand(1);
  auto options = std::make_shared<DatasetOptions>();
  CLI::App* render_command = command->add_subcommand(
      "render", "Renders annotated images as COCO, split for training, validation and evaluation.");
  render_command->add_option("out", options->out, "folder")->required();
  render_command->add_option("--seed", options->seed, "of everything that is drawn")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  render_command->add_option("--set", options->settings, "KEY=VALUE, such as images=500")
      ->take_all();
  render_command->callback([options, &exit_code] { exit_code = render(*options); });
}

}  // namespace furrow::cli
