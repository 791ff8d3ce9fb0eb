#include "field_import.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "furrow_annotation/mask.hpp"
#include "furrow_annotation/read_dataset.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::cli {
namespace {

template <class T>
T value_or_throw(Result<T> result) {
  if (!result.ok()) throw ConfigError(result.error().message);
  return std::move(*result);
}

field::ImagePlant to_plant(const annotation::AnnotatedInstance& instance,
                           const ImportOptions& options) {
  const annotation::MaskMeasures measures = annotation::measure(instance);
  field::ImagePlant plant;
  plant.kind = instance.kind == annotation::SubClassKind::kCrop ? field::PlantKind::kCrop
                                                                : field::PlantKind::kWeed;
  const auto meaning = options.categories.find(instance.category);
  if (meaning != options.categories.end()) plant.species = meaning->second.species;
  plant.stem_px = instance.stem_px.value_or(measures.centroid_px);
  plant.area_px2 = measures.area_px2;
  plant.radius_px = annotation::reach_px(instance, plant.stem_px);
  return plant;
}

std::vector<field::PlantImage> to_images(const annotation::Dataset& dataset,
                                         const ImportOptions& options) {
  std::vector<field::PlantImage> images;
  for (const annotation::AnnotatedImage& image : dataset.images) {
    field::PlantImage measured{image.path.filename().string(), image.width_px, image.height_px, {}};
    for (const annotation::AnnotatedInstance& instance : image.instances) {
      if (!instance.crowd) measured.plants.push_back(to_plant(instance, options));
    }
    images.push_back(std::move(measured));
  }
  return images;
}

std::string base_name(const std::string& file) {
  const auto path = std::filesystem::path(file).lexically_normal();
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

field::FieldModel import_images(const std::string& file, const ImportOptions& options,
                                std::vector<std::string>& notes) {
  annotation::CocoOptions how;
  how.strict = options.strict;
  how.unknown_kind = annotation::UnknownKind::kRefuse;
  for (const auto& [name, meaning] : options.categories) {
    how.kinds[name] = meaning.kind == field::PlantKind::kCrop ? annotation::SubClassKind::kCrop
                                                              : annotation::SubClassKind::kWeed;
  }
  auto dataset = annotation::read_dataset(file, vision::read_mask, how);
  if (!dataset.ok() && dataset.error().code == ErrorCode::kNotFound &&
      std::filesystem::exists(file)) {
    throw ConfigError(dataset.error().message + "; say it by --category NAME=crop or NAME=weed");
  }
  const annotation::Dataset read = value_or_throw(std::move(dataset));
  for (std::string& line : annotation::describe(read.report, file)) notes.push_back(line);
  if (read.report.ignore_regions > 0) {
    notes.push_back(file + ": " + std::to_string(read.report.ignore_regions) +
                    " regions to ignore (iscrowd) are no plants");
  }
  field::LaidImages laid = value_or_throw(field::lay_images(
      to_images(read, options), options.layout, base_name(file), "imported: " + file));
  if (laid.outside > 0) {
    const std::string message =
        file + ": " + std::to_string(laid.outside) + " plants with a stem outside their image";
    if (options.strict) throw ConfigError(message);
    notes.push_back(message + " skipped");
  }
  return std::move(laid.field);
}

field::FieldModel import_file(const std::string& file, const ImportOptions& options,
                              std::vector<std::string>& notes) {
  if (std::filesystem::is_directory(file)) return import_images(file, options, notes);
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".json" && extension != ".csv" && extension != ".geojson") {
    throw ConfigError(file +
                      " is neither COCO (.json), .csv, .geojson nor a folder of annotated images");
  }
  if (extension == ".json") return import_images(file, options, notes);
  const std::string text = value_or_throw(read_file(file));
  if (extension == ".csv") return value_or_throw(field::from_csv(text, file));
  return value_or_throw(field::from_geojson(text, file, options.origin));
}

/// Behind what there is, with ids that go on.
void append(field::FieldModel& field, const field::FieldModel& next, double gap_m) {
  std::int64_t id = 0;
  for (const field::Plant& plant : field.plants) id = std::max(id, plant.id + 1);
  const double shift_m = field.length_m + gap_m;
  for (field::Plant plant : next.plants) {
    plant.p_F_m.x() += shift_m;
    plant.id = id++;
    field.plants.push_back(std::move(plant));
  }
  field.length_m = shift_m + next.length_m;
  field.width_m = std::max(field.width_m, next.width_m);
}

}  // namespace

ImportedField import_field(const ImportOptions& options) {
  ImportedField imported;
  field::FieldModel& field = imported.field;
  std::string source;
  for (const std::string& file : options.files) {
    const field::FieldModel next = import_file(file, options, imported.notes);
    source += (source.empty() ? "imported: " : ", ") + base_name(file);
    if (field.plants.empty() && field.length_m == 0.0) {
      field = next;
    } else {
      append(field, next, options.layout.gap_m);
    }
  }
  field.name = options.name;
  field.source = source;
  field::sort_plants(field);
  if (const Status valid = field::validate(field); !valid.ok()) {
    throw ConfigError(valid.error().message);
  }
  return imported;
}

std::pair<std::string, CategoryMeaning> parse_category(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':', equals == std::string::npos ? 0 : equals);
  const auto kind = equals == std::string::npos
                        ? std::nullopt
                        : field::plant_kind_from(text.substr(
                              equals + 1, colon == std::string::npos ? colon : colon - equals - 1));
  if (!kind || equals == 0) {
    throw ConfigError("--category: '" + text +
                      "' is not NAME=crop, NAME=weed or NAME=weed:SPECIES");
  }
  return {text.substr(0, equals),
          {*kind, colon == std::string::npos ? std::string() : text.substr(colon + 1)}};
}

}  // namespace furrow::cli
