#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"

namespace furrow::actuation {

/// One spray as the robot made it: the record for the as-applied map.
struct Application {
  std::string axis;
  Time time;                                      ///< the valve opened
  double open_s = 0.0;                            ///< by the commands
  double volume_ml = 0.0;                         ///< estimated
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();  ///< centre of the footprint, as computed
  double radius_m = 0.0;                          ///< of the footprint
  std::vector<std::int64_t> track_ids;
};

/// The ground that at least one footprint covers, sampled on a grid of 2.5 mm; footprints smaller
/// than that count for nothing. Applications that are not finite are left out. O(n log n) for
/// footprints that overlap few others.
[[nodiscard]] double sprayed_area_m2(std::span<const Application> applications);

/// A FeatureCollection (RFC 7946) with a Point for each application, in their order.
/// `to_lon_lat_deg` gives {longitude, latitude} on WGS 84 of a point in F.
[[nodiscard]] std::string as_applied_geojson(
    std::span<const Application> applications,
    const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& to_lon_lat_deg);

}  // namespace furrow::actuation
