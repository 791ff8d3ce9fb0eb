#pragma once

#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_geometry/geodetic.hpp"
#include "furrow_localization/measurement.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

/// Origin and direction of the field frame on the earth (WGS 84).
struct GeoreferenceParameters {
  double origin_latitude_deg = 50.6150;
  double origin_longitude_deg = 6.9870;
  double origin_altitude_m = 170.0;
  double row_angle_deg = 0.0;

  void visit(ParameterVisitor& v);
  /// For Description::shared_parameters(): the field frame has one place on the earth.
  [[nodiscard]] static std::vector<std::string> names();
};

/// Converts between NavSatFix and positions in the field frame.
class Georeference {
 public:
  /// Throws ConfigError.
  explicit Georeference(const GeoreferenceParameters& parameters);

  /// Status GBAS stands for RTK. It is a fixed solution if its standard deviation is at most
  /// kFixedSigma_m. A covariance of unknown type leaves that of the measurement empty.
  [[nodiscard]] localization::GnssPosition from_msg(const sensor_msgs::msg::NavSatFix& fix) const;
  /// Why a filter did not use the fix, and what to do: "GNSS: the receiver has no fix (status -1)".
  [[nodiscard]] std::string refusal(const sensor_msgs::msg::NavSatFix& fix,
                                    localization::Outcome outcome) const;
  /// A covariance of zero is published as unknown.
  [[nodiscard]] sensor_msgs::msg::NavSatFix to_msg(
      const localization::GnssPosition& position) const;

  static constexpr double kFixedSigma_m = 0.05;

 private:
  geometry::FieldGeoreference georeference_;
  Eigen::Matrix2d R_EF_;  ///< from the field frame to east and north
};

}  // namespace furrow::components
