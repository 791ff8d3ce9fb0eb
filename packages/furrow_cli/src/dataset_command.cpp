#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "furrow_annotation/read_dataset.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/rendered_dataset.hpp"
#include "furrow_core/text.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/settings.hpp"
#include "furrow_vision/dataset_conversion.hpp"
#include "furrow_vision/dataset_groups.hpp"
#include "furrow_vision/image_file.hpp"
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
  std::vector<std::string> crops;
  std::string group_by;
  double gap_s = 0.0;
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

/// The named categories are crops, and those of which the file says nothing are weeds. Without
/// names such a file is refused: a crop that is taken for a weed would be sprayed.
annotation::Dataset read_set(const ConvertOptions& options) {
  annotation::CocoOptions how;
  how.unknown_kind = options.crops.empty() ? annotation::UnknownKind::kRefuse
                                           : annotation::UnknownKind::kAssumeWeed;
  for (const std::string& crop : options.crops) {
    how.kinds[crop] = annotation::SubClassKind::kCrop;
  }
  auto read = annotation::read_dataset(options.in, vision::read_mask, how);
  if (!read.ok()) {
    const std::filesystem::path in = options.in;
    const bool is_coco =
        std::filesystem::is_regular_file(in) || std::filesystem::exists(in / "evaluation.json");
    const bool unknown_kind =
        is_coco && read.error().code == ErrorCode::kNotFound && options.crops.empty();
    throw ConfigError(read.error().message +
                      (unknown_kind ? "; name each crop by --crop NAME" : ""));
  }
  annotation::Dataset dataset = std::move(read).value();
  std::vector<std::string> names;
  for (const annotation::SubClass& category : dataset.classes) names.push_back(category.name);
  for (const std::string& crop : options.crops) {
    if (std::ranges::find(names, crop) != names.end()) continue;
    throw ConfigError("--crop: " + options.in + " has no category '" + crop + "'" +
                      did_you_mean(crop, names));
  }
  return dataset;
}

/// Puts the images that show the same place into one sequence, which the split keeps together.
void group(const ConvertOptions& options, annotation::Dataset& dataset) {
  if (options.group_by.empty() && options.gap_s <= 0.0) return;
  if (!options.group_by.empty() && options.gap_s > 0.0) {
    throw ConfigError("--group-by and --gap are two ways to group images; give one");
  }
  const auto groups = options.group_by.empty() ? vision::group_by_time(options.gap_s, dataset)
                                               : vision::group_by_path(options.group_by, dataset);
  if (!groups.ok()) {
    throw ConfigError((options.group_by.empty() ? "--gap: " : "--group-by: ") +
                      groups.error().message);
  }
  std::cout << dataset.images.size() << " images in " << *groups
            << " groups, each in one of the sets\n";
}

int convert(const ConvertOptions& options) {
  annotation::Dataset dataset = read_set(options);
  group(options, dataset);
  for (const std::string& note : annotation::describe(dataset.report, options.in)) {
    std::cerr << "furrow: " << note << '\n';
  }
  const std::size_t images = dataset.images.size();
  const OutputFolder out = claim_dataset(options.out, options.force);
  ProgressBar bar("converting");
  const Status done = vision::convert_dataset(
      dataset, options.parameters, options.seed, out.path(), [&](std::size_t count) {
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
  command.option("--crop", options->crops,
                 "category that is a crop, where the file does not say so; the others are weeds");
  command.option("--group-by", options->group_by,
                 "regular expression; images whose paths match alike stay in one set");
  command
      .option("--gap", options->gap_s,
              "images less than this after the one before stay in one set, s; 0: no groups by time")
      .range(0.0, 1e6);
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
