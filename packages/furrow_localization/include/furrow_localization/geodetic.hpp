#pragma once

#include <Eigen/Core>

#include "furrow_core/result.hpp"

namespace furrow::localization {

/// A position on WGS 84: geodetic latitude and longitude, height above the ellipsoid.
struct GeodeticPosition {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;
};

/// Defining constants of WGS 84 (NIMA TR8350.2, 2000).
inline constexpr double kWgs84SemiMajorAxis_m = 6378137.0;
inline constexpr double kWgs84Flattening = 1.0 / 298.257223563;

/// Earth-centred, earth-fixed coordinates in metres.
[[nodiscard]] Eigen::Vector3d geodetic_to_ecef(const GeodeticPosition& position);
/// Inverse of geodetic_to_ecef to better than 1e-8 m, for points farther than 1000 km from the
/// earth's centre. Longitude in (-pi, pi]; at the poles 0.
[[nodiscard]] GeodeticPosition ecef_to_geodetic(const Eigen::Vector3d& p_ecef_m);

/// A plane that touches the ellipsoid's normal at an origin: x east, y north, z up, in metres.
class LocalTangentPlane {
 public:
  /// kInvalidArgument: not finite, |latitude| > pi/2, |longitude| > 2 pi, or |height| > 100 km.
  [[nodiscard]] static Result<LocalTangentPlane> at(const GeodeticPosition& origin);

  [[nodiscard]] Eigen::Vector3d to_enu(const GeodeticPosition& position) const;
  [[nodiscard]] GeodeticPosition to_geodetic(const Eigen::Vector3d& p_enu_m) const;
  [[nodiscard]] const GeodeticPosition& origin() const { return origin_; }

 private:
  LocalTangentPlane() = default;
  GeodeticPosition origin_;
  Eigen::Vector3d origin_ecef_m_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d enu_from_ecef_ = Eigen::Matrix3d::Identity();
};

/// The field frame F on the earth: its origin, and the row direction (F's x) as an angle counted
/// counter-clockwise from east.
class FieldGeoreference {
 public:
  /// As LocalTangentPlane::at; also kInvalidArgument when the angle is not finite.
  [[nodiscard]] static Result<FieldGeoreference> at(const GeodeticPosition& origin,
                                                    double row_angle_rad);

  [[nodiscard]] Eigen::Vector3d to_field(const GeodeticPosition& position) const;
  [[nodiscard]] GeodeticPosition to_geodetic(const Eigen::Vector3d& p_F_m) const;

 private:
  FieldGeoreference(LocalTangentPlane plane, double row_angle_rad);
  LocalTangentPlane plane_;
  double cosine_;
  double sine_;
};

}  // namespace furrow::localization
