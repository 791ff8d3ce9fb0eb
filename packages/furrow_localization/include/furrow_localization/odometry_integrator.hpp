#pragma once

#include <cstdint>
#include <memory>

#include "furrow_core/parameters.hpp"
#include "furrow_localization/pose_estimator.hpp"

namespace furrow::localization {

struct OdometryIntegratorParameters {
  double initial_x_m = 0.0;
  double initial_y_m = 0.0;
  double initial_heading_rad = 0.0;
  double history_s = 1.0;
  std::int64_t history_measurements = 512;
  double max_extrapolation_s = 0.5;
  double max_gap_s = 1.0;
  double odometry_timeout_s = 0.2;
  double degraded_position_sigma_m = 0.10;
  double lost_position_sigma_m = 1.0;

  void visit(ParameterVisitor& v);
};

/// Dead reckoning along circular arcs, with the mean of neighbouring wheel measurements, and the
/// newest one after it. The covariance grows by the measurements' variances. IMU and GNSS are
/// ignored. A measurement older than the newest is counted as too old. Across a gap longer than
/// `max_gap_s` the pose stays, and motion continues at the new measurement.
class OdometryIntegrator final : public PoseEstimator {
 public:
  /// Throws ConfigError when a parameter is out of its range.
  explicit OdometryIntegrator(const OdometryIntegratorParameters& parameters = {});
  ~OdometryIntegrator() override;
  OdometryIntegrator(OdometryIntegrator&&) noexcept;
  OdometryIntegrator& operator=(OdometryIntegrator&&) noexcept;

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
