#include "furrow_components/field_source.hpp"

#include <algorithm>

#include "furrow_configuration/parameter_file.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/field_geojson.hpp"
#include "furrow_field/generator.hpp"

namespace furrow::components {
namespace {

template <class T>
T value_or_throw(Result<T> result) {
  if (!result.ok()) throw ConfigError(result.error().message);
  return std::move(result).value();
}

}  // namespace

field::SpeciesTable load_species(const std::filesystem::path& path) {
  if (path.empty()) return field::SpeciesTable::defaults();
  return field::SpeciesTable(configuration::load_parameter_list<field::Species>(path, "species"));
}

field::FieldModel load_field(const std::filesystem::path& path, const field::SpeciesTable& species,
                             double length_m, std::uint64_t seed) {
  const std::string extension = path.extension().string();
  if (extension == ".csv") {
    return value_or_throw(field::from_csv(value_or_throw(read_file(path)), path.string()));
  }
  if (extension == ".geojson" || extension == ".json") {
    return value_or_throw(field::from_geojson(value_or_throw(read_file(path)), path.string()));
  }
  if (extension != ".yaml") {
    throw ConfigError({path.string(), 0}, "",
                      "is not a field file: use .yaml (a preset), .csv or .geojson");
  }
  auto parameters = configuration::load_parameter_file<field::FieldParameters>(path);
  if (length_m > 0.0) parameters.length_m = length_m;
  auto field = field::generate_field(parameters, species, seed);
  if (!field.ok()) throw ConfigError({path.string(), 0}, "", field.error().message);
  return std::move(field).value();
}

}  // namespace furrow::components
