#include <iostream>
#include <memory>

#include "commands.hpp"
#include "field_file.hpp"
#include "field_import.hpp"
#include "furrow_field/statistics.hpp"

namespace furrow::cli {
namespace {

struct Options {
  ImportOptions import;
  std::vector<std::string> categories;
  std::vector<double> origin;
  std::string out;
  bool force = false;
};

int import(Options options) {
  FieldFile file(options.out, options.force);
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
  file.write(field);
  const field::FieldStatistics statistics = field::statistics_of(field);
  std::cout << file.path().string() << ": " << size_and_counts(field, statistics) << " ("
            << field.source << ")\n";
  return 0;
}

}  // namespace

void add_field_import_command(Command root) {
  Command command = field_group(root).subcommand(
      "import", "Makes a field of annotated images or of listed plants.");
  auto options = std::make_shared<Options>();
  ImportOptions& import_options = options->import;
  command
      .option("files", import_options.files,
              "COCO (.json), plants (.csv, .geojson), folders of CWFID, Carrot-Weed, COCO; along "
              "the row in this "
              "order")
      .required();
  command.option("--out", options->out, "file that ends in .csv or .geojson").required();
  command.flag("--strict", import_options.strict,
               "refuse a file with a bad annotation instead of skipping it");
  add_force_option(command, options->force);
  command.option("--name", import_options.name, "name of the field");
  command
      .option("--resolution", import_options.layout.ground_resolution_mm_per_px,
              "ground resolution of the images, mm per pixel")
      .positive();
  command.option("--gap", import_options.layout.gap_m, "bare ground between images, m")
      .at_least(0.0);
  command
      .option("--travel", import_options.layout.travel, "image direction that lies along the row")
      .choices({"up", "right"});
  command.option("--category", options->categories,
                 "meaning of a category of a COCO file: NAME=crop, NAME=weed:SPECIES");
  command
      .option("--origin", options->origin,
              "latitude, longitude (degrees) and heading (degrees from east to north) of the "
              "field's origin, for GeoJSON that does not state them")
      .values(3);
  command.on_run([options] { return import(*options); });
}

}  // namespace furrow::cli
