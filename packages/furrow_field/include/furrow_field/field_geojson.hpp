#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// Where the field frame's origin stands on the earth (WGS 84), its height above the ellipsoid, and
/// where its x axis points, counted from east to north.
struct GeoOrigin {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double heading_rad = 0.0;
  double altitude_m = 0.0;
};

/// A FeatureCollection with a Point for each plant. With an origin the coordinates are WGS 84, as
/// RFC 7946 has them, of the plane that touches the ellipsoid there (geometry::FieldGeoreference);
/// without one they are metres in the field frame. Which one, and the field's
/// name, source and size, stands in the member "furrow". Fails where validate() does, or for an
/// origin that is not on the earth.
[[nodiscard]] Result<std::string> to_geojson(const FieldModel& field,
                                             const std::optional<GeoOrigin>& origin = std::nullopt);

/// Reads what to_geojson writes, and Point collections of others that have the property "kind":
/// without the member "furrow" the coordinates are WGS 84, and `origin` must be given. Errors
/// (kParse, kOutOfRange) read "origin: feature N: key: what is wrong", N counted from 0.
[[nodiscard]] Result<FieldModel> from_geojson(
    std::string_view text, std::string_view file,
    const std::optional<GeoOrigin>& origin = std::nullopt);

}  // namespace furrow::field
