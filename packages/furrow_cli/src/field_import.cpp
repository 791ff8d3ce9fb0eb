#include "field_import.hpp"

#include <algorithm>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_vision/dataset_cwfid.hpp"

namespace furrow::cli {
namespace {

template <class T>
T value_or_throw(Result<T> result) {
  if (!result.ok()) throw ConfigError(result.error().message);
  return std::move(*result);
}

field::AnnotatedPlant to_plant(const vision::AnnotatedInstance& instance) {
  field::AnnotatedPlant plant;
  plant.kind = instance.kind == vision::SubClassKind::kCrop ? field::PlantKind::kCrop
                                                            : field::PlantKind::kWeed;
  plant.stem_px = instance.stem_px;
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(instance.mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE,
                   instance.box_px.tl());
  for (const auto& contour : contours) {
    field::Polygon polygon;
    for (const cv::Point& point : contour) polygon.emplace_back(point.x, point.y);
    plant.polygons_px.push_back(std::move(polygon));
  }
  return plant;
}

std::vector<field::AnnotatedImage> read_cwfid_images(const std::filesystem::path& folder) {
  const vision::Dataset dataset = value_or_throw(vision::read_cwfid(folder));
  std::vector<field::AnnotatedImage> images;
  for (const vision::AnnotatedImage& image : dataset.images) {
    field::AnnotatedImage drawn{
        image.path.filename().string(), image.width_px, image.height_px, {}};
    for (const vision::AnnotatedInstance& instance : image.instances) {
      drawn.plants.push_back(to_plant(instance));
    }
    images.push_back(std::move(drawn));
  }
  return images;
}

std::string base_name(const std::string& file) {
  const auto path = std::filesystem::path(file).lexically_normal();
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

field::FieldModel lay(const std::vector<field::AnnotatedImage>& images, const std::string& file,
                      const ImportOptions& options) {
  return value_or_throw(
             field::lay_images(images, options.layout, base_name(file), "imported: " + file))
      .field;
}

field::FieldModel import_file(const std::string& file, const ImportOptions& options) {
  if (std::filesystem::is_directory(file)) return lay(read_cwfid_images(file), file, options);
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".json" && extension != ".csv" && extension != ".geojson") {
    throw ConfigError(file + " is neither COCO (.json), .csv, .geojson nor a folder of CWFID");
  }
  const std::string text = value_or_throw(read_file(file));
  if (extension == ".csv") return value_or_throw(field::from_csv(text, file));
  if (extension == ".geojson") {
    return value_or_throw(field::from_geojson(text, file, options.origin));
  }
  return lay(value_or_throw(field::parse_coco(text, file, options.categories)), file, options);
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

field::FieldModel import_field(const ImportOptions& options) {
  field::FieldModel field;
  std::string source;
  for (const std::string& file : options.files) {
    const field::FieldModel next = import_file(file, options);
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
  return field;
}

std::pair<std::string, field::CategoryMeaning> parse_category(const std::string& text) {
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
