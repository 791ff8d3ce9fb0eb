#include "field_file.hpp"

#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/field_geojson.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

OutputFile claim_field_file(const std::string& path, bool force) {
  const auto extension = std::filesystem::path(path).extension();
  if (extension != ".csv" && extension != ".geojson") {
    throw ConfigError("--out: " + path + " must end in .csv or .geojson");
  }
  return claim_file(path, force);
}

}  // namespace

FieldFile::FieldFile(const std::string& path, bool force)
    : file_(claim_field_file(path, force)), csv_(file_.path().extension() == ".csv") {}

void FieldFile::write(const field::FieldModel& field) {
  const auto text = csv_ ? field::to_csv(field) : field::to_geojson(field);
  if (!text.ok()) throw ConfigError(text.error().message);
  write_or_throw(file_, *text);
}

std::string size_and_counts(const field::FieldModel& field,
                            const field::FieldStatistics& statistics) {
  constexpr double kLine_m = 0.01;
  const bool line = field.length_m < kLine_m || field.width_m < kLine_m;
  return fixed(field.length_m, 2) + " m x " + fixed(field.width_m, 2) + " m, " +
         std::to_string(statistics.crops) + " crops, " + std::to_string(statistics.weeds) +
         " weeds, " +
         (line ? "on one line: no density" : fixed(statistics.weeds_per_m2, 2) + " weeds/m2");
}

}  // namespace furrow::cli
