#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "field_import.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/statistics.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

struct Options {
  ImportOptions import;
  std::vector<std::string> categories;
  std::vector<double> origin;
  std::string out;
};

void import(Options options) {
  const std::string extension = std::filesystem::path(options.out).extension().string();
  if (extension != ".csv" && extension != ".geojson") {
    throw ConfigError("--out: " + options.out + " must end in .csv or .geojson");
  }
  for (const std::string& category : options.categories) {
    options.import.categories.insert(parse_category(category));
  }
  if (!options.origin.empty()) {
    constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
    options.import.origin = {options.origin[0], options.origin[1], kRadPerDeg * options.origin[2]};
  }
  const ImportedField imported = import_field(options.import);
  for (const std::string& note : imported.notes) std::cerr << "furrow: " << note << '\n';
  const field::FieldModel& field = imported.field;
  const auto text = extension == ".csv" ? field::to_csv(field) : field::to_geojson(field);
  if (!text.ok()) throw ConfigError(text.error().message);
  if (const Status written = write_file_atomically(options.out, *text); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  const field::FieldStatistics statistics = field::statistics_of(field);
  std::cout << options.out << ": " << number(field.length_m, 2) << " m x "
            << number(field.width_m, 2) << " m, " << statistics.crops << " crops, "
            << statistics.weeds << " weeds, " << number(statistics.weeds_per_m2, 1) << " weeds/m2 ("
            << field.source << ")\n";
}

}  // namespace

void add_field_import_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* field = group(app, "field", "Makes and shows field models.");
  CLI::App* command =
      field->add_subcommand("import", "Makes a field of annotated images or listed plants.");
  auto options = std::make_shared<Options>();
  ImportOptions& import_options = options->import;
  command
      ->add_option("files", import_options.files,
                   "COCO (.json), plants (.csv, .geojson), folders of annotated images (CWFID, "
                   "Carrot-Weed, COCO); along the row in this order")
      ->required();
  command->add_option("--out", options->out, ".csv or .geojson")->required();
  command->add_option("--name", import_options.name, "of the field")->capture_default_str();
  command
      ->add_option("--resolution", import_options.layout.ground_resolution_mm_per_px,
                   "mm of ground for each pixel of an image")
      ->capture_default_str();
  command->add_option("--gap", import_options.layout.gap_m, "bare ground between images, m")
      ->capture_default_str();
  command
      ->add_option("--travel", import_options.layout.travel,
                   "image direction that lies along the row")
      ->check(CLI::IsMember({"up", "right"}))
      ->capture_default_str();
  command->add_option("--category", options->categories,
                      "what a category of a COCO file stands for: NAME=crop, NAME=weed:SPECIES");
  command->add_flag("--strict", import_options.strict,
                    "refuse a file with a bad annotation instead of skipping it");
  command
      ->add_option("--origin", options->origin,
                   "latitude, longitude and heading (degrees, from east to north) of the field's "
                   "origin, for GeoJSON of others")
      ->expected(3);
  command->callback([options] { import(*options); });
}

}  // namespace furrow::cli
