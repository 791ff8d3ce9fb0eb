#pragma once

#include <Eigen/Core>
#include <memory>

#include "furrow_core/result.hpp"

namespace GeographicLib {
class LocalCartesian;
}

/// All conversions between WGS 84 and the field frame: GNSS fixes in, sprays and field files out.
/// The formulas are GeographicLib's (Karney), accurate to nanometres at every latitude and
/// longitude. Link furrow_geometry::furrow_geodesy.
namespace furrow::geometry {

/// A position on WGS 84: geodetic latitude and longitude in degrees, as receivers and files give
/// them, and height above the ellipsoid.
struct GeodeticPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double height_m = 0.0;
};

/// The field frame F on the earth: the plane perpendicular to the ellipsoid's normal at an origin,
/// z up. The row direction (F's x) is an angle counter-clockwise from east. Const calls are
/// thread-safe; copies are cheap.
class FieldGeoreference {
 public:
  /// kInvalidArgument: a value is not finite, |latitude| > 90 deg, |longitude| > 360 deg, or
  /// |height| > 100 km.
  [[nodiscard]] static Result<FieldGeoreference> at(const GeodeticPosition& origin,
                                                    double row_angle_rad);

  /// Accepts any longitude, also across the date line.
  [[nodiscard]] Eigen::Vector3d to_field(const GeodeticPosition& position) const;
  /// Longitude in [-180, 180] deg.
  [[nodiscard]] GeodeticPosition to_geodetic(const Eigen::Vector3d& p_F_m) const;

  /// The point of the plane z = 0 at a longitude (x) and latitude (y) in degrees, for maps without
  /// heights. Inverse of to_lon_lat_deg. NaN for a latitude beyond a pole, and for a place farther
  /// than 1000 km from the origin.
  [[nodiscard]] Eigen::Vector2d from_lon_lat_deg(const Eigen::Vector2d& lon_lat_deg) const;
  [[nodiscard]] Eigen::Vector2d to_lon_lat_deg(const Eigen::Vector2d& p_F_m) const;

 private:
  FieldGeoreference(std::shared_ptr<const GeographicLib::LocalCartesian> plane,
                    double row_angle_rad);
  std::shared_ptr<const GeographicLib::LocalCartesian> plane_;  ///< x east, y north, z up
  double cosine_;
  double sine_;
};

}  // namespace furrow::geometry
