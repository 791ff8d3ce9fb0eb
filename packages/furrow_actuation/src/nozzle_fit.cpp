#include "furrow_actuation/nozzle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "furrow_core/error.hpp"
#include "furrow_core/statistics.hpp"

namespace furrow::actuation {
namespace {

/// Pairs of like speed say nothing about the slope.
double slope_over_speed(std::span<const LandingOffset> sprays) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < sprays.size(); ++i) {
    for (std::size_t k = i + 1; k < sprays.size(); ++k) {
      const double apart_mps = sprays[k].speed_mps - sprays[i].speed_mps;
      if (std::abs(apart_mps) < kMinSpeedSpread_mps / 2.0) continue;
      slopes.push_back((sprays[k].offset_m.x() - sprays[i].offset_m.x()) / apart_mps);
    }
  }
  return median(std::move(slopes));
}

}  // namespace

Result<NozzleFit> fit_nozzle(const NozzleCalibration& used, std::span<const LandingOffset> sprays) {
  for (const LandingOffset& spray : sprays) {
    if (!std::isfinite(spray.speed_mps) || !spray.offset_m.allFinite()) {
      return Error{ErrorCode::kInvalidArgument, "a measured offset is not finite"};
    }
  }
  if (sprays.size() < kMinLandingOffsets) {
    return Error{ErrorCode::kInvalidArgument,
                 "only " + std::to_string(sprays.size()) + " sprays were measured, " +
                     std::to_string(kMinLandingOffsets) + " are needed"};
  }
  const auto [slowest, fastest] = std::ranges::minmax(sprays, {}, &LandingOffset::speed_mps);
  if (fastest.speed_mps - slowest.speed_mps < kMinSpeedSpread_mps) {
    return Error{ErrorCode::kInvalidArgument,
                 "all sprays were made at one speed; delay and offset cannot be told apart"};
  }
  NozzleFit fit{.calibration = used};
  fit.delay_change_s = slope_over_speed(sprays);
  std::vector<double> rest_x;
  std::vector<double> rest_y;
  for (const LandingOffset& spray : sprays) {
    rest_x.push_back(spray.offset_m.x() - fit.delay_change_s * spray.speed_mps);
    rest_y.push_back(spray.offset_m.y());
  }
  fit.offset_change_m = {median(std::move(rest_x)), median(std::move(rest_y))};
  fit.calibration.open_delay_s += fit.delay_change_s;
  fit.calibration.close_delay_s += fit.delay_change_s;
  fit.calibration.offset_x_m += fit.offset_change_m.x();
  fit.calibration.offset_y_m += fit.offset_change_m.y();
  constexpr double kRounding_s = 1e-4;
  for (double* delay_s : {&fit.calibration.open_delay_s, &fit.calibration.close_delay_s}) {
    if (*delay_s < -kRounding_s) {
      return Error{ErrorCode::kOutOfRange,
                   "the sprays land farther behind than a valve without delay explains"};
    }
    *delay_s = std::max(0.0, *delay_s);
  }
  return fit;
}

std::optional<double> distance_quantile_m(std::span<const LandingOffset> sprays, double p) {
  if (sprays.empty()) return std::nullopt;
  std::vector<double> distances;
  for (const LandingOffset& spray : sprays) distances.push_back(spray.offset_m.norm());
  return quantile(std::move(distances), p);
}

}  // namespace furrow::actuation
