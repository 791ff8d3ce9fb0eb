#include "furrow_localization/geodetic.hpp"

#include <cmath>
#include <numbers>

namespace furrow::localization {
namespace {

constexpr double kEccentricity2 = kWgs84Flattening * (2.0 - kWgs84Flattening);
constexpr double kMaxHeight_m = 1e5;

Error invalid(const char* message) {
  return Error{ErrorCode::kInvalidArgument, message};
}

double prime_vertical_radius_m(double sine_latitude) {
  return kWgs84SemiMajorAxis_m / std::sqrt(1.0 - kEccentricity2 * sine_latitude * sine_latitude);
}

}  // namespace

Eigen::Vector3d geodetic_to_ecef(const GeodeticPosition& position) {
  const double sine = std::sin(position.latitude_rad);
  const double cosine = std::cos(position.latitude_rad);
  const double radius_m = prime_vertical_radius_m(sine);
  const double from_axis_m = (radius_m + position.height_m) * cosine;
  return {from_axis_m * std::cos(position.longitude_rad),
          from_axis_m * std::sin(position.longitude_rad),
          (radius_m * (1.0 - kEccentricity2) + position.height_m) * sine};
}

GeodeticPosition ecef_to_geodetic(const Eigen::Vector3d& p_ecef_m) {
  const double from_axis_m = std::hypot(p_ecef_m.x(), p_ecef_m.y());
  // Bowring's (1976) iteration on the parametric latitude; each step gains about nine digits near
  // the surface.
  const double semi_minor_axis_m = kWgs84SemiMajorAxis_m * (1.0 - kWgs84Flattening);
  const double second_eccentricity2 = kEccentricity2 / (1.0 - kEccentricity2);
  double parametric = std::atan2(p_ecef_m.z(), (1.0 - kWgs84Flattening) * from_axis_m);
  double latitude = 0.0;
  for (int step = 0; step < 4; ++step) {
    const double s = std::sin(parametric);
    const double c = std::cos(parametric);
    latitude = std::atan2(p_ecef_m.z() + second_eccentricity2 * semi_minor_axis_m * s * s * s,
                          from_axis_m - kEccentricity2 * kWgs84SemiMajorAxis_m * c * c * c);
    parametric = std::atan2((1.0 - kWgs84Flattening) * std::sin(latitude), std::cos(latitude));
  }
  const double sine = std::sin(latitude);
  // Along the ellipsoid's normal; well-conditioned at the poles too.
  const double height_m = from_axis_m * std::cos(latitude) + p_ecef_m.z() * sine -
                          kWgs84SemiMajorAxis_m * std::sqrt(1.0 - kEccentricity2 * sine * sine);
  const double longitude = from_axis_m > 0.0 ? std::atan2(p_ecef_m.y(), p_ecef_m.x()) : 0.0;
  return {latitude, longitude, height_m};
}

Result<LocalTangentPlane> LocalTangentPlane::at(const GeodeticPosition& origin) {
  if (!(std::abs(origin.latitude_rad) <= 0.5 * std::numbers::pi)) {
    return invalid("the latitude is not in [-pi/2, pi/2]");
  }
  if (!(std::abs(origin.longitude_rad) <= 2.0 * std::numbers::pi)) {
    return invalid("the longitude is not in [-2 pi, 2 pi]");
  }
  if (!(std::abs(origin.height_m) <= kMaxHeight_m)) {
    return invalid("the height is not within 100 km of the ellipsoid");
  }
  LocalTangentPlane plane;
  plane.origin_ = origin;
  plane.origin_ecef_m_ = geodetic_to_ecef(origin);
  const double sin_lat = std::sin(origin.latitude_rad);
  const double cos_lat = std::cos(origin.latitude_rad);
  const double sin_lon = std::sin(origin.longitude_rad);
  const double cos_lon = std::cos(origin.longitude_rad);
  plane.enu_from_ecef_ << -sin_lon, cos_lon, 0.0,       //
      -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat,  //
      cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return plane;
}

Eigen::Vector3d LocalTangentPlane::to_enu(const GeodeticPosition& position) const {
  return enu_from_ecef_ * (geodetic_to_ecef(position) - origin_ecef_m_);
}

GeodeticPosition LocalTangentPlane::to_geodetic(const Eigen::Vector3d& p_enu_m) const {
  return ecef_to_geodetic(origin_ecef_m_ + enu_from_ecef_.transpose() * p_enu_m);
}

FieldGeoreference::FieldGeoreference(LocalTangentPlane plane, double row_angle_rad)
    : plane_(std::move(plane)), cosine_(std::cos(row_angle_rad)), sine_(std::sin(row_angle_rad)) {}

Result<FieldGeoreference> FieldGeoreference::at(const GeodeticPosition& origin,
                                                double row_angle_rad) {
  if (!std::isfinite(row_angle_rad)) return invalid("the row's angle is not finite");
  Result<LocalTangentPlane> plane = LocalTangentPlane::at(origin);
  if (!plane) return plane.error();
  return FieldGeoreference(*plane, row_angle_rad);
}

Eigen::Vector3d FieldGeoreference::to_field(const GeodeticPosition& position) const {
  const Eigen::Vector3d p = plane_.to_enu(position);
  return {cosine_ * p.x() + sine_ * p.y(), cosine_ * p.y() - sine_ * p.x(), p.z()};
}

GeodeticPosition FieldGeoreference::to_geodetic(const Eigen::Vector3d& p_F_m) const {
  return plane_.to_geodetic({cosine_ * p_F_m.x() - sine_ * p_F_m.y(),
                             sine_ * p_F_m.x() + cosine_ * p_F_m.y(), p_F_m.z()});
}

}  // namespace furrow::localization
