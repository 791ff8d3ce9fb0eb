#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "furrow_field/field_geojson.hpp"
#include "furrow_field/image_layout.hpp"

namespace furrow::cli {

/// What a category of a COCO file stands for.
struct CategoryMeaning {
  field::PlantKind kind = field::PlantKind::kWeed;
  std::string species;  ///< empty: not known
};

struct ImportOptions {
  std::vector<std::string> files;
  std::string name = "imported";
  field::LayoutParameters layout;  ///< its gap also stands between fields
  std::map<std::string, CategoryMeaning> categories;
  std::optional<field::GeoOrigin> origin;
  bool strict = false;  ///< refuse a file with a bad annotation instead of skipping it
};

struct ImportedField {
  field::FieldModel field;
  std::vector<std::string> notes;  ///< skipped annotations and assumptions, a line each
};

/// Plants of annotated images (COCO files; folders of CWFID, Carrot-Weed or COCO), CSV and GeoJSON
/// files, one after another along the row. Regions to ignore are no plants. A plant stands at its
/// marked stem, else at the centroid of its mask. Throws ConfigError that names the file.
[[nodiscard]] ImportedField import_field(const ImportOptions& options);

/// NAME=KIND or NAME=KIND:SPECIES, KIND crop or weed. Throws ConfigError.
[[nodiscard]] std::pair<std::string, CategoryMeaning> parse_category(const std::string& text);

}  // namespace furrow::cli
