#pragma once

#include <cstdint>
#include <memory>

#include "furrow_core/parameters.hpp"
#include "furrow_localization/pose_estimator.hpp"

namespace furrow::localization {

struct PoseFilterParameters {
  double initial_x_m = 0.0;
  double initial_y_m = 0.0;
  double initial_heading_rad = 0.0;
  double initial_position_sigma_m = 0.5;
  double initial_heading_sigma_rad = 0.1;
  double initial_gyro_bias_sigma_radps = 0.01;
  double initial_speed_scale_sigma = 0.02;
  double initial_wheel_curvature_sigma_radpm = 0.01;

  double acceleration_sigma = 1.0;
  double yaw_acceleration_sigma = 0.5;
  double slip_sigma_m_per_sqrt_s = 0.001;
  double gyro_bias_walk = 1e-4;
  double speed_scale_walk = 1e-4;
  double wheel_curvature_walk = 1e-4;

  double antenna_x_m = 0.0;
  double antenna_y_m = 0.0;
  double rtk_fixed_sigma_m = 0.010;
  double rtk_float_sigma_m = 0.15;
  double differential_sigma_m = 0.5;
  double single_sigma_m = 2.0;
  double min_gnss_sigma_m = 0.005;
  bool use_odometry = true;
  bool use_imu = true;
  bool use_gnss = true;

  double gate_probability = 0.999;
  std::int64_t gnss_recovery_repeats = 10;
  std::int64_t rate_recovery_repeats = 3;
  double recovery_heading_sigma_rad = 0.05;

  double history_s = 1.0;
  std::int64_t history_measurements = 512;
  double max_extrapolation_s = 0.5;
  double max_jump_ahead_s = 60.0;
  double odometry_timeout_s = 0.2;
  double gnss_timeout_s = 1.0;
  double degraded_position_sigma_m = 0.03;
  double lost_position_sigma_m = 0.30;

  void visit(ParameterVisitor& v);
};

/// Extended Kalman filter over (x, y, heading, speed, yaw rate, gyro bias, wheel speed scale, wheel
/// curvature). Motion model: no sideways slip, constant speed and yaw rate driven by white
/// acceleration (Bar-Shalom, Li and Kirubarajan 2001). Wheels measure (1 + scale) * speed and
/// yaw rate + curvature * speed; the gyroscope measures yaw rate + bias; GNSS measures the antenna.
/// Updates in Joseph form, each gated by chi-square of its innovation.
///
/// The filter keeps the measurements of the last `history_s`. A late one is inserted at its stamp,
/// and the later ones are applied again: the estimate is bit-identical to that of the ordered
/// sequence. GNSS that contradicts the state is rejected until `gnss_recovery_repeats` consistent
/// ones follow each other; rates likewise with `rate_recovery_repeats`. A stamp more than
/// `max_jump_ahead_s` ahead is invalid, until `gnss_recovery_repeats` in a row agree: then the
/// filter continues from there. A clock that was set back needs a reset().
///
/// Without reset() the filter starts at the first measurement with the initial pose of its
/// parameters. The initial heading must be right to a few times initial_heading_sigma_rad; the
/// filter does not recover from an error above about 60 degrees.
class PoseFilter final : public PoseEstimator {
 public:
  /// Throws ConfigError when a parameter is out of its range.
  explicit PoseFilter(const PoseFilterParameters& parameters = {});
  ~PoseFilter() override;
  PoseFilter(PoseFilter&&) noexcept;
  PoseFilter& operator=(PoseFilter&&) noexcept;

  [[nodiscard]] Status reset(Time stamp, const geometry::Pose2& X_FB,
                             const Eigen::Matrix3d& covariance) override;
  Outcome add(const WheelOdometry& measurement) override;
  Outcome add(const ImuYawRate& measurement) override;
  Outcome add(const GnssPosition& measurement) override;
  [[nodiscard]] Result<PoseEstimate> predict(Time stamp) const override;
  [[nodiscard]] LocalizationHealth health(Time now) const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::localization
