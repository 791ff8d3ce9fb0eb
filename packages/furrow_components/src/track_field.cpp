#include "furrow_components/track_field.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/field_geojson.hpp"

namespace furrow::components {
namespace {

std::vector<double> crop_rows(const field::FieldModel& field) {
  constexpr double kGap_m = 0.2;
  constexpr std::size_t kLeast = 5;
  std::vector<double> ys;
  for (const field::Plant& plant : field.plants) {
    if (plant.kind == field::PlantKind::kCrop) ys.push_back(plant.p_F_m.y());
  }
  std::ranges::sort(ys);
  std::vector<double> rows;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= ys.size(); ++i) {
    if (i < ys.size() && ys[i] - ys[i - 1] <= kGap_m) continue;
    if (i - begin >= kLeast) rows.push_back(ys[begin + (i - begin) / 2]);
    begin = i;
  }
  return rows;
}

}  // namespace

void TrackFieldParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "field_model_file",
           .description = "file to which the confirmed tracks are saved as a field at the end of "
                          "the run, .csv or .geojson; empty: none"},
          field_model_file);
  v.visit({.name = "length_m",
           .unit = "m",
           .description = "length of the row of which tracks are saved",
           .min = 0.1,
           .max = 10000.0},
          length_m);
  v.visit({.name = "field_model_crop_species",
           .description = "species of a crop for which the detector has none"},
          field_model_crop_species);
  v.visit({.name = "field_model_weed_species",
           .description = "species of a weed for which the detector has none"},
          field_model_weed_species);
}

field::FieldModel field_of_tracks(std::span<const tracking::Track> tracks,
                                  const SpeciesNames& species,
                                  const TrackFieldParameters& parameters) {
  field::FieldModel field{
      .name = "tracked", .source = "confirmed tracks of a run", .length_m = parameters.length_m};
  for (const tracking::Track& track : tracks) {
    const Eigen::Vector2d& p_F = track.p_F_m;
    if (!track.confirmed || p_F.x() < 0.0 || p_F.x() > field.length_m) continue;
    field::Plant& plant = field.plants.emplace_back();
    plant.id = static_cast<std::int64_t>(track.id);
    const bool crop = track.plant_class() == tracking::PlantClass::kCrop;
    plant.kind = crop ? field::PlantKind::kCrop : field::PlantKind::kWeed;
    plant.species = species.of_kind(track).value_or(crop ? parameters.field_model_crop_species
                                                         : parameters.field_model_weed_species);
    plant.p_F_m = p_F;
    plant.radius_m = track.radius_m;
    plant.area_mm2 = track.area_mm2;
    field.width_m = std::max(field.width_m, 2.0 * std::abs(p_F.y()));
  }
  field::sort_plants(field);
  field.row_y_m = crop_rows(field);
  return field;
}

Status write_field(const field::FieldModel& field, const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".csv" && extension != ".geojson") {
    return Error{ErrorCode::kInvalidArgument, file + ": .csv or .geojson is needed"};
  }
  const auto text = extension == ".csv" ? field::to_csv(field) : field::to_geojson(field);
  if (!text.ok()) return text.error();
  return write_file_atomically(file, *text);
}

}  // namespace furrow::components
