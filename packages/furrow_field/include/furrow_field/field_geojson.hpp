#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// Where the field frame's origin stands on the earth (WGS84) and where its x axis points, counted
/// from east to north.
struct GeoOrigin {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double heading_rad = 0.0;
};

/// {longitude, latitude} in degrees of a point of the field, on the plane that touches the
/// ellipsoid at the origin (radii of curvature of WGS84 at its latitude). Below 55 degrees of
/// latitude it is less than 1.2 cm off within 300 m. @pre |latitude| < 89 degrees.
[[nodiscard]] Eigen::Vector2d to_wgs84(const GeoOrigin& origin, const Eigen::Vector2d& p_F_m);
/// The exact inverse of to_wgs84.
[[nodiscard]] Eigen::Vector2d from_wgs84(const GeoOrigin& origin,
                                         const Eigen::Vector2d& lon_lat_deg);

/// A FeatureCollection with a Point for each plant. With an origin the coordinates are WGS84, as
/// RFC 7946 has them; without one they are metres in the field frame. Which one, and the field's
/// name, source and size, stands in the member "furrow". Fails where validate() does, or for an
/// origin that is not on the earth.
[[nodiscard]] Result<std::string> to_geojson(const FieldModel& field,
                                             const std::optional<GeoOrigin>& origin = std::nullopt);

/// Reads what to_geojson writes, and Point collections of others that have the property "kind":
/// without the member "furrow" the coordinates are WGS84, and `origin` must be given. Errors
/// (kParse, kOutOfRange) read "origin: feature N: key: what is wrong", N counted from 0.
[[nodiscard]] Result<FieldModel> from_geojson(
    std::string_view text, std::string_view file,
    const std::optional<GeoOrigin>& origin = std::nullopt);

}  // namespace furrow::field
