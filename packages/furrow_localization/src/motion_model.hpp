#pragma once

#include <Eigen/Core>

#include "furrow_core/time.hpp"
#include "furrow_localization/measurement.hpp"
#include "furrow_localization/pose_estimator.hpp"
#include "furrow_localization/pose_filter.hpp"

namespace furrow::localization {

/// Indices into the filter's state.
enum StateIndex : int { kX, kY, kHeading, kSpeed, kYawRate, kGyroBias, kSpeedScale, kCurvature };
inline constexpr int kStates = 8;
using StateVector = Eigen::Matrix<double, kStates, 1>;
using StateCovariance = Eigen::Matrix<double, kStates, kStates>;

/// Measurements in a row that were rejected.
struct Repeats {
  int speed = 0;
  int wheel_yaw_rate = 0;
  int gyro = 0;
  int gnss = 0;
  Eigen::Vector2d gnss_innovation = Eigen::Vector2d::Zero();  ///< of the last of them
};

/// The filter's state at one time.
struct FilterState {
  Time stamp = {};
  StateVector x = StateVector::Zero();
  StateCovariance P = StateCovariance::Identity();
  Repeats repeats = {};
};

/// The filter's equations, stateless: prediction, and the update for each sensor.
class MotionModel {
 public:
  explicit MotionModel(const PoseFilterParameters& parameters);

  [[nodiscard]] FilterState initial_state(Time stamp, const geometry::Pose2& X_FB,
                                          const Eigen::Matrix3d& covariance) const;
  /// @pre stamp >= state.stamp.
  void predict(FilterState& state, Time stamp) const;
  Outcome update(FilterState& state, const WheelOdometry& measurement) const;
  Outcome update(FilterState& state, const ImuYawRate& measurement) const;
  Outcome update(FilterState& state, const GnssPosition& measurement) const;

  [[nodiscard]] static PoseEstimate estimate(const FilterState& state);
  /// The covariance to use for a GNSS measurement. @pre it has a fix.
  [[nodiscard]] Eigen::Matrix2d gnss_covariance(const GnssPosition& measurement) const;

 private:
  void step(FilterState& state, double dt_s) const;
  /// One gated scalar measurement with Jacobian `h`; `widened` is the state whose variance
  /// grows when the measurement has been rejected too often.
  Outcome update_scalar(FilterState& state, const StateVector& h, double innovation,
                        double variance, StateIndex widened, int& repeats) const;

  PoseFilterParameters parameters_;
  double gate_1_;  ///< chi-square bounds by degrees of freedom
  double gate_2_;
};

}  // namespace furrow::localization
