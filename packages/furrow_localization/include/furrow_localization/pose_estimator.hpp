#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_localization/measurement.hpp"

namespace furrow::localization {

/// Pose and twist of the base frame B in the field frame F at one time.
struct PoseEstimate {
  Time stamp = {};
  geometry::Pose2 X_FB = {};
  /// Of (x_m, y_m, heading_rad), in F.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double speed_mps = 0.0;  ///< along B's x
  double yaw_rate_radps = 0.0;
  /// Of (speed_mps, yaw_rate_radps).
  Eigen::Matrix2d twist_covariance = Eigen::Matrix2d::Zero();
};

/// Counts of one sensor's measurements by Outcome.
struct SensorCounts {
  std::int64_t used = 0;  ///< including late and recovered ones
  std::int64_t late = 0;
  std::int64_t gated = 0;
  std::int64_t recovered = 0;
  std::int64_t no_fix = 0;
  std::int64_t duplicate = 0;
  std::int64_t too_old = 0;
  std::int64_t invalid = 0;
  std::int64_t ignored = 0;

  void count(Outcome outcome);
};

enum class HealthLevel : std::uint8_t { kOk, kDegraded, kLost };

/// The estimator's health as data. Ages are seconds since the newest measurement used, infinite
/// where there was none.
struct LocalizationHealth {
  HealthLevel level = HealthLevel::kLost;
  double odometry_age_s = 0.0;
  double imu_age_s = 0.0;
  double gnss_age_s = 0.0;
  FixQuality fix_quality = FixQuality::kNone;  ///< of the newest GNSS measurement used
  double position_sigma_m = 0.0;               ///< along the worst direction
  double heading_sigma_rad = 0.0;
  SensorCounts odometry;
  SensorCounts imu;
  SensorCounts gnss;
};

/// A running estimate of the robot's pose. Measurements may arrive late and out of order; their
/// stamps are the only time. Not thread-safe.
class PoseEstimator {
 public:
  virtual ~PoseEstimator() = default;

  /// Restarts at a known pose; drops all measurements, keeps the counts. `covariance` is of
  /// (x_m, y_m, heading_rad). kInvalidArgument: not finite, or the covariance not positive
  /// semi-definite.
  [[nodiscard]] virtual Status reset(Time stamp, const geometry::Pose2& X_FB,
                                     const Eigen::Matrix3d& covariance) = 0;

  virtual Outcome add(const WheelOdometry& measurement) = 0;
  virtual Outcome add(const ImuYawRate& measurement) = 0;
  virtual Outcome add(const GnssPosition& measurement) = 0;

  /// The pose at `stamp`, from all measurements so far: within the history, or up to the
  /// extrapolation limit after the newest measurement. kUnavailable: no measurement yet. kStale:
  /// outside those bounds.
  [[nodiscard]] virtual Result<PoseEstimate> predict(Time stamp) const = 0;

  [[nodiscard]] virtual LocalizationHealth health(Time now) const = 0;
};

}  // namespace furrow::localization
