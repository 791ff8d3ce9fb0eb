#include "furrow_geometry/geodetic.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace furrow::geometry {
namespace {

constexpr double kMaxHeight_m = 1e5;
constexpr double kFarthest_m = 1e6;

Error invalid_origin(const char* message) {
  return Error{ErrorCode::kInvalidArgument, message};
}

}  // namespace

FieldGeoreference::FieldGeoreference(std::shared_ptr<const GeographicLib::LocalCartesian> plane,
                                     double row_angle_rad)
    : plane_(std::move(plane)), cosine_(std::cos(row_angle_rad)), sine_(std::sin(row_angle_rad)) {}

Result<FieldGeoreference> FieldGeoreference::at(const GeodeticPosition& origin,
                                                double row_angle_rad) {
  if (!(std::abs(origin.latitude_deg) <= 90.0)) {
    return invalid_origin("the latitude is not in [-90, 90] degrees");
  }
  if (!(std::abs(origin.longitude_deg) <= 360.0)) {
    return invalid_origin("the longitude is not in [-360, 360] degrees");
  }
  if (!(std::abs(origin.height_m) <= kMaxHeight_m)) {
    return invalid_origin("the height is not within 100 km of the ellipsoid");
  }
  if (!std::isfinite(row_angle_rad)) return invalid_origin("the row's angle is not finite");
  return FieldGeoreference(std::make_shared<const GeographicLib::LocalCartesian>(
                               origin.latitude_deg, origin.longitude_deg, origin.height_m),
                           row_angle_rad);
}

Eigen::Vector3d FieldGeoreference::to_field(const GeodeticPosition& position) const {
  double east_m = 0.0, north_m = 0.0, up_m = 0.0;
  plane_->Forward(position.latitude_deg, position.longitude_deg, position.height_m, east_m, north_m,
                  up_m);
  return {cosine_ * east_m + sine_ * north_m, cosine_ * north_m - sine_ * east_m, up_m};
}

GeodeticPosition FieldGeoreference::to_geodetic(const Eigen::Vector3d& p_F_m) const {
  GeodeticPosition position;
  plane_->Reverse(cosine_ * p_F_m.x() - sine_ * p_F_m.y(), sine_ * p_F_m.x() + cosine_ * p_F_m.y(),
                  p_F_m.z(), position.latitude_deg, position.longitude_deg, position.height_m);
  return position;
}

Eigen::Vector2d FieldGeoreference::from_lon_lat_deg(const Eigen::Vector2d& lon_lat_deg) const {
  // The normals of a field's points are nearly parallel: each step leaves a millionth of the
  // height.
  GeodeticPosition position{lon_lat_deg.y(), lon_lat_deg.x(), plane_->HeightOrigin()};
  Eigen::Vector3d p_F_m = to_field(position);
  if (!(p_F_m.norm() <= kFarthest_m)) {
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  for (int step = 0; step < 3; ++step) {
    position.height_m -= p_F_m.z();
    p_F_m = to_field(position);
  }
  return p_F_m.head<2>();
}

Eigen::Vector2d FieldGeoreference::to_lon_lat_deg(const Eigen::Vector2d& p_F_m) const {
  const GeodeticPosition position = to_geodetic({p_F_m.x(), p_F_m.y(), 0.0});
  return {position.longitude_deg, position.latitude_deg};
}

}  // namespace furrow::geometry
