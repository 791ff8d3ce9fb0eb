#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "furrow_field/annotations.hpp"
#include "furrow_field/field_geojson.hpp"
#include "furrow_field/image_layout.hpp"

namespace furrow::cli {

struct ImportOptions {
  std::vector<std::string> files;
  std::string name = "imported";
  field::LayoutParameters layout;  ///< its gap also stands between fields
  std::map<std::string, field::CategoryMeaning> categories;
  std::optional<field::GeoOrigin> origin;
};

/// Plants of COCO files, CWFID folders, CSV and GeoJSON files, one after another along the row.
/// Throws ConfigError that names the file.
[[nodiscard]] field::FieldModel import_field(const ImportOptions& options);

/// NAME=KIND or NAME=KIND:SPECIES, KIND crop or weed. Throws ConfigError.
[[nodiscard]] std::pair<std::string, field::CategoryMeaning> parse_category(
    const std::string& text);

}  // namespace furrow::cli
