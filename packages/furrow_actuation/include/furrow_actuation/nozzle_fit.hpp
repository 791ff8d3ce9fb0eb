#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "furrow_actuation/nozzle.hpp"
#include "furrow_core/result.hpp"

namespace furrow::actuation {

/// One spray of a test pattern, driven straight along F's x: where it landed beside its aim.
struct LandingOffset {
  double speed_mps = 0.0;                              ///< of the robot
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  ///< landing minus aim, x along the way
};

struct NozzleFit {
  NozzleCalibration calibration;
  double delay_change_s = 0.0;  ///< of both valve delays
  Eigen::Vector2d offset_change_m = Eigen::Vector2d::Zero();
};

/// What a nozzle's calibration must become for its sprays to land on their aims. A delay that is
/// too short puts the spray ahead by speed times delay, an offset by the same at every speed. So
/// the delay is the slope over speed: the median of the pairwise slopes (Theil 1950, Sen 1968). The
/// offset is the median of the remainder. Up to 29 % of wild measurements do no harm.
/// kInvalidArgument: not finite, fewer than kMinLandingOffsets, or speeds less than
/// kMinSpeedSpread_mps apart. kOutOfRange: no valve delay of at least 0 explains it.
[[nodiscard]] Result<NozzleFit> fit_nozzle(const NozzleCalibration& used,
                                           std::span<const LandingOffset> sprays);

inline constexpr std::size_t kMinLandingOffsets = 6;
inline constexpr double kMinSpeedSpread_mps = 0.1;

/// The p-quantile of the distances |offset|, p in [0, 1]; nothing when there are none.
[[nodiscard]] std::optional<double> distance_quantile_m(std::span<const LandingOffset> sprays,
                                                        double p);

}  // namespace furrow::actuation
