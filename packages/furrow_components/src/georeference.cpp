#include "furrow_components/georeference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/stamp.hpp"

namespace furrow::components {
namespace {

using localization::FixQuality;
using localization::GnssPosition;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// Constants of sensor_msgs/NavSatStatus, whose status is a signed byte, and of NavSatFix.
constexpr std::uint8_t kNoFix = 255;
constexpr std::uint8_t kPlainFix = 0;
constexpr std::uint8_t kSatelliteAugmented = 1;
constexpr std::uint8_t kGroundAugmented = 2;
constexpr std::uint8_t kCovarianceUnknown = 0;
constexpr std::uint8_t kCovarianceKnown = 3;

geometry::FieldGeoreference make(const GeoreferenceParameters& p) {
  auto made = geometry::FieldGeoreference::at(
      {p.origin_latitude_deg, p.origin_longitude_deg, p.origin_altitude_m},
      p.row_angle_deg * kRadPerDeg);
  if (!made.ok()) throw ConfigError("georeference: " + made.error().message);
  return std::move(made).value();
}

std::uint8_t status_of(FixQuality quality) {
  switch (quality) {
    case FixQuality::kNone:
      return kNoFix;
    case FixQuality::kSingle:
      return kPlainFix;
    case FixQuality::kDifferential:
      return kSatelliteAugmented;
    case FixQuality::kRtkFloat:
    case FixQuality::kRtkFixed:
      break;
  }
  return kGroundAugmented;
}

FixQuality quality_of(std::uint8_t status, double sigma_m) {
  switch (status) {
    case kPlainFix:
      return FixQuality::kSingle;
    case kSatelliteAugmented:
      return FixQuality::kDifferential;
    case kGroundAugmented:
      return sigma_m > Georeference::kFixedSigma_m ? FixQuality::kRtkFloat : FixQuality::kRtkFixed;
    default:
      return FixQuality::kNone;
  }
}

/// The first thing that makes a fix invalid.
std::string invalid_because(const sensor_msgs::msg::NavSatFix& fix, const GnssPosition& position) {
  if (!std::isfinite(fix.latitude()) || !std::isfinite(fix.longitude()) ||
      !std::isfinite(fix.altitude())) {
    return "latitude, longitude or altitude is not a number";
  }
  if (position.covariance && position.covariance->isZero(0.0)) {
    return "the covariance is zero, although its type says that it is known; the driver must set "
           "position_covariance_type to 0 or give a covariance";
  }
  if (position.covariance &&
      !(position.covariance->allFinite() && position.covariance->determinant() > 0.0 &&
        (*position.covariance)(0, 0) > 0.0)) {
    return "the covariance is not positive definite";
  }
  if (!in_field(position.p_FA_m.x(), position.p_FA_m.y())) {
    return "the fix is " + std::to_string(std::lround(position.p_FA_m.norm() / 1000.0)) +
           " km from the origin of the field; set common.origin_latitude_deg and "
           "common.origin_longitude_deg";
  }
  return "the stamp is far ahead of the other sensors; check the clock of its host";
}

}  // namespace

void GeoreferenceParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "origin_latitude_deg",
           .unit = "deg",
           .description = "latitude of the origin of the field frame, WGS 84; the same in all "
                          "components",
           .min = -90.0,
           .max = 90.0},
          origin_latitude_deg);
  v.visit({.name = "origin_longitude_deg",
           .unit = "deg",
           .description = "longitude of the origin of the field frame, WGS 84; the same in all "
                          "components",
           .min = -180.0,
           .max = 180.0},
          origin_longitude_deg);
  v.visit({.name = "origin_altitude_m",
           .unit = "m",
           .description = "height of the origin of the field frame above the ellipsoid; the same "
                          "in all components",
           .min = -1000.0,
           .max = 10000.0},
          origin_altitude_m);
  v.visit({.name = "row_angle_deg",
           .unit = "deg",
           .description = "direction of travel along the rows, counter-clockwise from east; the "
                          "same in all components",
           .min = -360.0,
           .max = 360.0},
          row_angle_deg);
}

std::vector<std::string> GeoreferenceParameters::names() {
  return {"origin_latitude_deg", "origin_longitude_deg", "origin_altitude_m", "row_angle_deg"};
}

Georeference::Georeference(const GeoreferenceParameters& parameters)
    : georeference_(make(parameters)),
      R_EF_(Eigen::Rotation2Dd(parameters.row_angle_deg * kRadPerDeg).toRotationMatrix()) {}

GnssPosition Georeference::from_msg(const sensor_msgs::msg::NavSatFix& fix) const {
  GnssPosition position{.stamp = graph::from_msg(fix.header().stamp())};
  position.p_FA_m =
      georeference_.to_field({fix.latitude(), fix.longitude(), fix.altitude()}).head<2>();
  double sigma_m = 0.0;
  if (fix.position_covariance_type() != kCovarianceUnknown) {
    const auto& c = fix.position_covariance();
    Eigen::Matrix2d covariance_E;
    covariance_E << c[0], c[1], c[3], c[4];
    position.covariance = R_EF_.transpose() * covariance_E * R_EF_;
    sigma_m = std::sqrt(std::max({c[0], c[4], 0.0}));
  }
  position.quality = quality_of(static_cast<std::uint8_t>(fix.status().status()), sigma_m);
  return position;
}

std::string Georeference::refusal(const sensor_msgs::msg::NavSatFix& fix,
                                  localization::Outcome outcome) const {
  using localization::Outcome;
  switch (outcome) {
    case Outcome::kNoFix:
      return "GNSS: the receiver has no fix (status " +
             std::to_string(static_cast<int>(static_cast<std::int8_t>(fix.status().status()))) +
             ")";
    case Outcome::kInvalid:
      return "GNSS: " + invalid_because(fix, from_msg(fix));
    case Outcome::kGated:
      return "GNSS: the fix contradicts the pose by more than their covariances allow";
    case Outcome::kDuplicate:
      return "GNSS: two fixes have the same stamp";
    case Outcome::kTooOld:
      return "GNSS: the stamp of the fix is older than the filter's history; check the clock of "
             "its host";
    default:
      return "GNSS: the fix was " + std::string(localization::to_string(outcome));
  }
}

sensor_msgs::msg::NavSatFix Georeference::to_msg(const GnssPosition& position) const {
  sensor_msgs::msg::NavSatFix fix;
  fix.header(header(position.stamp, "gnss_antenna"));
  fix.status().status(status_of(position.quality));
  const auto geodetic = georeference_.to_geodetic({position.p_FA_m.x(), position.p_FA_m.y(), 0.0});
  fix.latitude(geodetic.latitude_deg);
  fix.longitude(geodetic.longitude_deg);
  fix.altitude(geodetic.height_m);
  fix.position_covariance_type(kCovarianceUnknown);
  if (!position.covariance || position.covariance->isZero(0.0)) return fix;
  const Eigen::Matrix2d covariance_E = R_EF_ * *position.covariance * R_EF_.transpose();
  fix.position_covariance_type(kCovarianceKnown);
  fix.position_covariance()[0] = covariance_E(0, 0);
  fix.position_covariance()[1] = covariance_E(0, 1);
  fix.position_covariance()[3] = covariance_E(1, 0);
  fix.position_covariance()[4] = covariance_E(1, 1);
  // Receivers have about twice the variance in height.
  fix.position_covariance()[8] = 2.0 * covariance_E.trace();
  return fix;
}

}  // namespace furrow::components
