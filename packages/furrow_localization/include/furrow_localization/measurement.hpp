#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "furrow_core/time.hpp"

namespace furrow::localization {

/// Motion of the base frame B as the wheels' encoders give it.
struct WheelOdometry {
  Time stamp = {};
  double speed_mps = 0.0;  ///< along B's x
  double yaw_rate_radps = 0.0;
  double speed_variance = 1e-4;     ///< (m/s)2
  double yaw_rate_variance = 4e-4;  ///< (rad/s)2
};

/// Turning rate of the base frame about its z axis, as a gyroscope gives it.
struct ImuYawRate {
  Time stamp = {};
  double yaw_rate_radps = 0.0;
  double yaw_rate_variance = 2.5e-5;  ///< (rad/s)2
};

enum class FixQuality : std::uint8_t { kNone, kSingle, kDifferential, kRtkFloat, kRtkFixed };
[[nodiscard]] std::string_view to_string(FixQuality quality);

/// Position of the GNSS antenna A in the field frame F (furrow_geometry/geodetic.hpp converts).
struct GnssPosition {
  Time stamp = {};
  Eigen::Vector2d p_FA_m = Eigen::Vector2d::Zero();
  FixQuality quality = FixQuality::kRtkFixed;
  /// In m2, where the receiver gives one; else the filter's figure for the quality is used.
  std::optional<Eigen::Matrix2d> covariance = std::nullopt;
};

/// Result of adding a measurement.
enum class Outcome : std::uint8_t {
  kUsed,
  kUsedLate,   ///< inserted at its stamp, before measurements that arrived earlier
  kGated,      ///< contradicts the state; rejected
  kRecovered,  ///< the state was reset to repeated, consistent measurements
  kNoFix,      ///< a GNSS message without a position
  kDuplicate,  ///< kind and stamp are known already
  kTooOld,     ///< before the start of the history
  kInvalid,    ///< not finite, a covariance that is not positive, or a stamp out of bounds
  kIgnored,    ///< of a sensor that this estimator does not use
};
[[nodiscard]] std::string_view to_string(Outcome outcome);

}  // namespace furrow::localization
