#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// The field frame's origin on WGS 84 with its height above the ellipsoid, and the direction of its
/// x axis, counter-clockwise from east.
struct GeoOrigin {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double heading_rad = 0.0;
  double altitude_m = 0.0;
};

/// A FeatureCollection (RFC 7946) with a Point for each plant. With an origin the coordinates are
/// longitude and latitude on WGS 84 (geometry::FieldGeoreference). Without one they are metres in
/// the field frame. The member "furrow" says which, and holds the field's name, source and size.
/// Fails where validate() does, or for an origin that is not on the earth.
[[nodiscard]] Result<std::string> to_geojson(const FieldModel& field,
                                             const std::optional<GeoOrigin>& origin = std::nullopt);

/// Reads the output of to_geojson, and Point collections of other programs with the property
/// "kind". Without the member "furrow" the coordinates are WGS 84, and `origin` is required. Errors
/// (kParse, kOutOfRange) read "file: feature N: key: message", N counted from 0.
[[nodiscard]] Result<FieldModel> from_geojson(
    std::string_view text, std::string_view file,
    const std::optional<GeoOrigin>& origin = std::nullopt);

}  // namespace furrow::field
