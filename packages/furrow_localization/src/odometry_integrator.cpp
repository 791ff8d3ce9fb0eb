#include "furrow_localization/odometry_integrator.hpp"

#include <cmath>
#include <limits>

#include "covariance.hpp"
#include "ring_buffer.hpp"

namespace furrow::localization {
namespace {

constexpr double kMaxRate = 100.0;

struct Reckoning {
  PoseEstimate estimate;
  WheelOdometry newest;  ///< the measurement at its stamp; zero motion before the first
};

PoseEstimate moved(const PoseEstimate& from, Time stamp, double speed_mps, double yaw_rate_radps,
                   double speed_variance, double yaw_rate_variance) {
  const double dt_s = (stamp - from.stamp).to_seconds();
  PoseEstimate to;
  to.stamp = stamp;
  to.X_FB = geometry::extrapolate(from.X_FB, {speed_mps, 0.0, yaw_rate_radps}, dt_s);
  to.speed_mps = speed_mps;
  to.yaw_rate_radps = yaw_rate_radps;
  to.twist_covariance = Eigen::Vector2d(speed_variance, yaw_rate_variance).asDiagonal();
  const double c = std::cos(from.X_FB.heading_rad + 0.5 * yaw_rate_radps * dt_s);
  const double s = std::sin(from.X_FB.heading_rad + 0.5 * yaw_rate_radps * dt_s);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = from.X_FB.y_m - to.X_FB.y_m;
  F(1, 2) = to.X_FB.x_m - from.X_FB.x_m;
  Eigen::Matrix<double, 3, 2> G;
  G << c * dt_s, -0.5 * s * speed_mps * dt_s * dt_s,  //
      s * dt_s, 0.5 * c * speed_mps * dt_s * dt_s,    //
      0.0, dt_s;
  to.covariance = F * from.covariance * F.transpose() + G * to.twist_covariance * G.transpose();
  return to;
}

}  // namespace

class OdometryIntegrator::Impl {
 public:
  explicit Impl(const OdometryIntegratorParameters& parameters)
      : parameters_((validate_parameters(parameters), parameters)),
        history_(static_cast<std::size_t>(parameters.history_measurements)) {}

  Status reset(Time stamp, const geometry::Pose2& X_FB, const Eigen::Matrix3d& covariance);
  Outcome add(const WheelOdometry& measurement);
  [[nodiscard]] Result<PoseEstimate> predict(Time stamp) const;
  [[nodiscard]] LocalizationHealth health(Time now) const;

  SensorCounts odometry_;
  SensorCounts imu_;
  SensorCounts gnss_;

 private:
  [[nodiscard]] static PoseEstimate between(const Reckoning& from, const Reckoning& to, Time stamp);
  void push(const Reckoning& reckoning);

  const OdometryIntegratorParameters parameters_;
  RingBuffer<Reckoning> history_;
  bool measured_ = false;
};

Status OdometryIntegrator::Impl::reset(Time stamp, const geometry::Pose2& X_FB,
                                       const Eigen::Matrix3d& covariance) {
  if (!std::isfinite(X_FB.x_m) || !std::isfinite(X_FB.y_m) || !std::isfinite(X_FB.heading_rad)) {
    return Error{ErrorCode::kInvalidArgument, "the pose is not finite"};
  }
  if (!is_semi_definite(covariance)) {
    return Error{ErrorCode::kInvalidArgument, "the covariance is not positive semi-definite"};
  }
  Reckoning start;
  start.estimate.stamp = stamp;
  start.estimate.X_FB = X_FB;
  start.estimate.covariance = covariance;
  start.newest.stamp = stamp;
  history_.clear();
  history_.insert(0) = start;
  measured_ = false;
  return {};
}

void OdometryIntegrator::Impl::push(const Reckoning& reckoning) {
  if (history_.full()) history_.pop_front();
  history_.insert(history_.size()) = reckoning;
  const Time oldest = reckoning.estimate.stamp - Duration::seconds(parameters_.history_s);
  while (history_.size() > 1 && history_.front().estimate.stamp < oldest) history_.pop_front();
}

Outcome OdometryIntegrator::Impl::add(const WheelOdometry& m) {
  const auto is_variance = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!(std::abs(m.speed_mps) <= kMaxRate) || !(std::abs(m.yaw_rate_radps) <= kMaxRate) ||
      !is_variance(m.speed_variance) || !is_variance(m.yaw_rate_variance)) {
    return Outcome::kInvalid;
  }
  Reckoning next;
  next.newest = m;
  if (history_.empty()) {
    next.estimate.X_FB = {parameters_.initial_x_m, parameters_.initial_y_m,
                          parameters_.initial_heading_rad};
  } else {
    const Reckoning& last = history_.back();
    if (m.stamp < last.estimate.stamp) return Outcome::kTooOld;
    if (measured_ && m.stamp == last.estimate.stamp) return Outcome::kDuplicate;
    next.estimate = last.estimate;
    if ((m.stamp - last.estimate.stamp).to_seconds() <= parameters_.max_gap_s) {
      // After a reset the first measurement is the only knowledge of the motion before it.
      const WheelOdometry& from = measured_ ? last.newest : m;
      next.estimate = moved(last.estimate, m.stamp, 0.5 * (from.speed_mps + m.speed_mps),
                            0.5 * (from.yaw_rate_radps + m.yaw_rate_radps), m.speed_variance,
                            m.yaw_rate_variance);
    }
  }
  next.estimate.stamp = m.stamp;
  next.estimate.speed_mps = m.speed_mps;
  next.estimate.yaw_rate_radps = m.yaw_rate_radps;
  next.estimate.twist_covariance =
      Eigen::Vector2d(m.speed_variance, m.yaw_rate_variance).asDiagonal();
  measured_ = true;
  push(next);
  return Outcome::kUsed;
}

PoseEstimate OdometryIntegrator::Impl::between(const Reckoning& from, const Reckoning& to,
                                               Time stamp) {
  const double fraction = (stamp - from.estimate.stamp).to_seconds() /
                          (to.estimate.stamp - from.estimate.stamp).to_seconds();
  const auto mix = [&](const auto& a, const auto& b) { return a + fraction * (b - a); };
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.X_FB = geometry::interpolate(from.estimate.X_FB, to.estimate.X_FB, fraction);
  estimate.covariance = mix(from.estimate.covariance, to.estimate.covariance);
  estimate.speed_mps = mix(from.estimate.speed_mps, to.estimate.speed_mps);
  estimate.yaw_rate_radps = mix(from.estimate.yaw_rate_radps, to.estimate.yaw_rate_radps);
  estimate.twist_covariance = to.estimate.twist_covariance;
  return estimate;
}

Result<PoseEstimate> OdometryIntegrator::Impl::predict(Time stamp) const {
  if (history_.empty()) return Error{ErrorCode::kUnavailable, "no measurement has come yet"};
  if (stamp < history_.front().estimate.stamp) {
    return Error{ErrorCode::kStale, "the time is before the history"};
  }
  const Reckoning& newest = history_.back();
  if ((stamp - newest.estimate.stamp).to_seconds() > parameters_.max_extrapolation_s) {
    return Error{ErrorCode::kStale, "the time is too far after the newest measurement"};
  }
  if (stamp >= newest.estimate.stamp) {
    return moved(newest.estimate, stamp, newest.newest.speed_mps, newest.newest.yaw_rate_radps,
                 newest.newest.speed_variance, newest.newest.yaw_rate_variance);
  }
  std::size_t i = history_.size() - 1;
  while (history_[i - 1].estimate.stamp > stamp) --i;
  return between(history_[i - 1], history_[i], stamp);
}

LocalizationHealth OdometryIntegrator::Impl::health(Time now) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  LocalizationHealth health;
  health.odometry = odometry_;
  health.imu = imu_;
  health.gnss = gnss_;
  health.odometry_age_s = health.imu_age_s = health.gnss_age_s = kInfinity;
  health.position_sigma_m = health.heading_sigma_rad = kInfinity;
  if (history_.empty()) return health;
  const PoseEstimate& newest = history_.back().estimate;
  if (measured_) health.odometry_age_s = (now - newest.stamp).to_seconds();
  health.position_sigma_m = std::sqrt(greatest_variance(newest.covariance.topLeftCorner<2, 2>()));
  health.heading_sigma_rad = std::sqrt(newest.covariance(2, 2));
  if (health.odometry_age_s > parameters_.max_extrapolation_s ||
      health.position_sigma_m > parameters_.lost_position_sigma_m) {
    health.level = HealthLevel::kLost;
  } else if (health.odometry_age_s > parameters_.odometry_timeout_s ||
             health.position_sigma_m > parameters_.degraded_position_sigma_m) {
    health.level = HealthLevel::kDegraded;
  } else {
    health.level = HealthLevel::kOk;
  }
  return health;
}

OdometryIntegrator::OdometryIntegrator(const OdometryIntegratorParameters& parameters)
    : impl_(std::make_unique<Impl>(parameters)) {}
OdometryIntegrator::~OdometryIntegrator() = default;
OdometryIntegrator::OdometryIntegrator(OdometryIntegrator&&) noexcept = default;
OdometryIntegrator& OdometryIntegrator::operator=(OdometryIntegrator&&) noexcept = default;

Status OdometryIntegrator::reset(Time stamp, const geometry::Pose2& X_FB,
                                 const Eigen::Matrix3d& covariance) {
  return impl_->reset(stamp, X_FB, covariance);
}

Outcome OdometryIntegrator::add(const WheelOdometry& measurement) {
  const Outcome outcome = impl_->add(measurement);
  impl_->odometry_.count(outcome);
  return outcome;
}

Outcome OdometryIntegrator::add(const ImuYawRate& /*measurement*/) {
  impl_->imu_.count(Outcome::kIgnored);
  return Outcome::kIgnored;
}

Outcome OdometryIntegrator::add(const GnssPosition& /*measurement*/) {
  impl_->gnss_.count(Outcome::kIgnored);
  return Outcome::kIgnored;
}

Result<PoseEstimate> OdometryIntegrator::predict(Time stamp) const {
  return impl_->predict(stamp);
}
LocalizationHealth OdometryIntegrator::health(Time now) const {
  return impl_->health(now);
}

}  // namespace furrow::localization
