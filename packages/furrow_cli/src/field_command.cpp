#include <filesystem>
#include <iostream>

#include "command.hpp"
#include "console.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/field_geojson.hpp"
#include "furrow_field/statistics.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

struct FieldOptions {
  std::string field = "sb20_s1_like";
  double length_m = 0.0;
  std::uint64_t seed = 1;
  std::string out = "field.csv";
};

field::FieldModel load(const FieldOptions& options) {
  const auto species = components::load_species(share_folder() / "params" / "species.yaml");
  return components::load_field(find_shipped(options.field, "fields"), species, options.length_m,
                                options.seed);
}

void generate(const FieldOptions& options) {
  const field::FieldModel field = load(options);
  const std::string extension = std::filesystem::path(options.out).extension().string();
  if (extension != ".csv" && extension != ".geojson") {
    throw ConfigError("--out: " + options.out + " must end in .csv or .geojson");
  }
  const auto text = extension == ".csv" ? field::to_csv(field) : field::to_geojson(field);
  if (!text.ok()) throw ConfigError(text.error().message);
  if (const Status written = write_file_atomically(options.out, *text); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << options.out << ": " << field.plants.size() << " plants (" << field.source << ")\n";
}

void show(const FieldOptions& options) {
  const field::FieldModel field = load(options);
  const field::FieldStatistics statistics = field::statistics_of(field);
  std::cout << field.name << ": " << field.source << '\n'
            << number(field.length_m, 2) << " m x " << number(field.width_m, 2) << " m, "
            << statistics.crops << " crops, " << statistics.weeds << " weeds, "
            << number(statistics.weeds_per_m2, 2) << " weeds/m2\n";
  std::vector<std::vector<std::string>> rows = {{"species", "plants"}};
  for (const auto& species : statistics.by_species) {
    rows.push_back({species.species, std::to_string(species.plants)});
  }
  std::cout << text_table(rows);
}

void add_field_options(CLI::App* command, FieldOptions& options) {
  command
      ->add_option("field", options.field,
                   "a shipped preset, a preset file, or plants as CSV or GeoJSON")
      ->capture_default_str();
  command->add_option("--length", options.length_m, "metres of row of a generated field");
  command->add_option("--seed", options.seed, "of a generated field")->capture_default_str();
}

}  // namespace

void add_field_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = app.add_subcommand("field", "Makes and shows field models.");
  command->require_subcommand(1);
  auto options = std::make_shared<FieldOptions>();
  CLI::App* generate_command = command->add_subcommand("generate", "Writes a field to a file.");
  add_field_options(generate_command, *options);
  generate_command->add_option("--out", options->out, ".csv or .geojson")->capture_default_str();
  generate_command->callback([options] { generate(*options); });
  CLI::App* show_command = command->add_subcommand("show", "Counts the plants of a field.");
  add_field_options(show_command, *options);
  show_command->callback([options] { show(*options); });
}

}  // namespace furrow::cli
