#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "field_file.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_core/text.hpp"
#include "furrow_field/statistics.hpp"
#include "furrow_launch/installation.hpp"

namespace furrow::cli {
namespace {

struct FieldOptions {
  std::string field = "sb20_s1_like";
  double length_m = 0.0;
  std::uint64_t seed = 1;
  std::string out = "field.csv";
  bool force = false;
};

field::FieldModel load(const FieldOptions& options) {
  const auto species = components::load_species(launch::share_folder() / "params" / "species.yaml");
  return components::load_field(launch::find_shipped(options.field, "fields"), species,
                                options.length_m, options.seed);
}

int generate(const FieldOptions& options) {
  FieldFile file(options.out, options.force);
  const field::FieldModel field = load(options);
  file.write(field);
  std::cout << file.path().string() << ": " << field.plants.size() << " plants (" << field.source
            << ")\n";
  return 0;
}

int show(const FieldOptions& options) {
  const field::FieldModel field = load(options);
  const field::FieldStatistics statistics = field::statistics_of(field);
  std::cout << field.name << ": " << field.source << '\n'
            << size_and_counts(field, statistics) << '\n';
  std::vector<std::vector<std::string>> rows = {{"species", "plants"}};
  for (const auto& species : statistics.by_species) {
    rows.push_back({species.species, std::to_string(species.plants)});
  }
  std::cout << text_table(rows);
  return 0;
}

void add_field_options(Command command, FieldOptions& options) {
  command.option("field", options.field,
                 "a shipped preset, a preset file, or plants as CSV or GeoJSON");
  command.option("--length", options.length_m, "length of a generated row, m; 0: the preset's")
      .at_least(0.0);
  command.option("--seed", options.seed, "seed of a generated field");
}

}  // namespace

void add_field_commands(Command root) {
  Command group = field_group(root);
  auto options = std::make_shared<FieldOptions>();
  Command generate_command = group.subcommand("generate", "Writes a field to a file.");
  add_field_options(generate_command, *options);
  generate_command.option("--out", options->out, "file that ends in .csv or .geojson");
  add_force_option(generate_command, options->force);
  generate_command.on_run([options] { return generate(*options); });
  Command show_command = group.subcommand("show", "Counts the plants of a field.");
  add_field_options(show_command, *options);
  show_command.on_run([options] { return show(*options); });
}

}  // namespace furrow::cli
