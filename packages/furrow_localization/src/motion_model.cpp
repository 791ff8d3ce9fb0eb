#include "motion_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "covariance.hpp"
#include "furrow_geometry/pose.hpp"

namespace furrow::localization {
namespace {

constexpr double kMaxStep_s = 0.05;
constexpr double kInitialSpeedSigma_mps = 1.0;
constexpr double kInitialYawRateSigma_radps = 0.5;

double square(double value) {
  return value * value;
}

/// The chi-square bound of one degree of freedom: P(z^2 < bound) = erf(sqrt(bound / 2)).
double chi_square_1(double probability) {
  double low = 0.0;
  double high = 200.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erf(std::sqrt(0.5 * middle)) < probability ? low : high) = middle;
  }
  return high;
}

void symmetrize(StateCovariance& P) {
  P = (0.5 * (P + P.transpose())).eval();
}

}  // namespace

MotionModel::MotionModel(const PoseFilterParameters& parameters)
    : parameters_(parameters),
      gate_1_(chi_square_1(parameters.gate_probability)),
      // P(chi-square of two degrees < bound) = 1 - exp(-bound / 2).
      gate_2_(-2.0 * std::log(1.0 - parameters.gate_probability)) {}

FilterState MotionModel::initial_state(Time stamp, const geometry::Pose2& X_FB,
                                       const Eigen::Matrix3d& covariance) const {
  FilterState state;
  state.stamp = stamp;
  state.x(kX) = X_FB.x_m;
  state.x(kY) = X_FB.y_m;
  state.x(kHeading) = geometry::wrap_angle_rad(X_FB.heading_rad);
  state.P.setZero();
  state.P.topLeftCorner<3, 3>() = covariance;
  state.P(kSpeed, kSpeed) = square(kInitialSpeedSigma_mps);
  state.P(kYawRate, kYawRate) = square(kInitialYawRateSigma_radps);
  state.P(kGyroBias, kGyroBias) = square(parameters_.initial_gyro_bias_sigma_radps);
  state.P(kSpeedScale, kSpeedScale) = square(parameters_.initial_speed_scale_sigma);
  state.P(kCurvature, kCurvature) = square(parameters_.initial_wheel_curvature_sigma_radpm);
  return state;
}

void MotionModel::predict(FilterState& state, Time stamp) const {
  const double span_s = (stamp - state.stamp).to_seconds();
  if (span_s > 0.0) {
    const int steps = std::max(1, static_cast<int>(std::ceil(span_s / kMaxStep_s - 1e-9)));
    for (int i = 0; i < steps; ++i) step(state, span_s / steps);
  }
  state.stamp = stamp;
}

void MotionModel::step(FilterState& state, double dt_s) const {
  StateVector& x = state.x;
  StateCovariance& P = state.P;
  const double middle_rad = x(kHeading) + 0.5 * x(kYawRate) * dt_s;
  const double c = std::cos(middle_rad);
  const double s = std::sin(middle_rad);
  const double v = x(kSpeed);

  // F differs from the identity only in the rows of the pose.
  const double x_by_heading = -v * s * dt_s;
  const double y_by_heading = v * c * dt_s;
  const double half = 0.5 * dt_s;
  P.row(kX) += x_by_heading * P.row(kHeading) + c * dt_s * P.row(kSpeed) +
               x_by_heading * half * P.row(kYawRate);
  P.row(kY) += y_by_heading * P.row(kHeading) + s * dt_s * P.row(kSpeed) +
               y_by_heading * half * P.row(kYawRate);
  P.row(kHeading) += dt_s * P.row(kYawRate);
  P.col(kX) += x_by_heading * P.col(kHeading) + c * dt_s * P.col(kSpeed) +
               x_by_heading * half * P.col(kYawRate);
  P.col(kY) += y_by_heading * P.col(kHeading) + s * dt_s * P.col(kSpeed) +
               y_by_heading * half * P.col(kYawRate);
  P.col(kHeading) += dt_s * P.col(kYawRate);

  const double slip = square(parameters_.slip_sigma_m_per_sqrt_s) * dt_s;
  P(kX, kX) += slip;
  P(kY, kY) += slip;
  P(kSpeed, kSpeed) += square(parameters_.acceleration_sigma) * dt_s;
  P(kYawRate, kYawRate) += square(parameters_.yaw_acceleration_sigma) * dt_s;
  P(kGyroBias, kGyroBias) += square(parameters_.gyro_bias_walk) * dt_s;
  P(kSpeedScale, kSpeedScale) += square(parameters_.speed_scale_walk) * dt_s;
  P(kCurvature, kCurvature) += square(parameters_.wheel_curvature_walk) * dt_s;

  x(kX) += v * c * dt_s;
  x(kY) += v * s * dt_s;
  x(kHeading) = geometry::wrap_angle_rad(x(kHeading) + x(kYawRate) * dt_s);
}

Outcome MotionModel::update_scalar(FilterState& state, const StateVector& h, double innovation,
                                   double variance, StateIndex widened, int& repeats) const {
  StateCovariance& P = state.P;
  StateVector Ph = P * h;
  double S = h.dot(Ph) + variance;
  Outcome outcome = Outcome::kUsed;
  if (square(innovation) > gate_1_ * S) {
    if (++repeats < parameters_.rate_recovery_repeats) return Outcome::kGated;
    P(widened, widened) += square(innovation);
    Ph = P * h;
    S = h.dot(Ph) + variance;
    outcome = Outcome::kRecovered;
  }
  repeats = 0;
  const StateVector K = Ph / S;
  state.x += K * innovation;
  state.x(kHeading) = geometry::wrap_angle_rad(state.x(kHeading));
  // Joseph form, (I - K h') P (I - K h')' + K R K', as rank-one changes.
  const StateCovariance A = P - K * Ph.transpose();
  P = A - (A * h) * K.transpose() + (variance * K) * K.transpose();
  symmetrize(P);
  return outcome;
}

Outcome MotionModel::update(FilterState& state, const WheelOdometry& measurement) const {
  StateVector h = StateVector::Zero();
  h(kSpeed) = 1.0 + state.x(kSpeedScale);
  h(kSpeedScale) = state.x(kSpeed);
  const Outcome speed = update_scalar(state, h, measurement.speed_mps - h(kSpeed) * state.x(kSpeed),
                                      measurement.speed_variance, kSpeed, state.repeats.speed);

  h.setZero();
  h(kYawRate) = 1.0;
  h(kSpeed) = state.x(kCurvature);
  h(kCurvature) = state.x(kSpeed);
  const double expected = state.x(kYawRate) + state.x(kCurvature) * state.x(kSpeed);
  const Outcome yaw_rate =
      update_scalar(state, h, measurement.yaw_rate_radps - expected, measurement.yaw_rate_variance,
                    kYawRate, state.repeats.wheel_yaw_rate);
  // The worse of the two tests is the message's.
  if (speed == Outcome::kGated || yaw_rate == Outcome::kGated) return Outcome::kGated;
  return speed == Outcome::kRecovered ? speed : yaw_rate;
}

Outcome MotionModel::update(FilterState& state, const ImuYawRate& measurement) const {
  StateVector h = StateVector::Zero();
  h(kYawRate) = 1.0;
  h(kGyroBias) = 1.0;
  const double expected = state.x(kYawRate) + state.x(kGyroBias);
  return update_scalar(state, h, measurement.yaw_rate_radps - expected,
                       measurement.yaw_rate_variance, kYawRate, state.repeats.gyro);
}

Eigen::Matrix2d MotionModel::gnss_covariance(const GnssPosition& measurement) const {
  double sigma_m = parameters_.single_sigma_m;
  switch (measurement.quality) {
    case FixQuality::kRtkFixed:
      sigma_m = parameters_.rtk_fixed_sigma_m;
      break;
    case FixQuality::kRtkFloat:
      sigma_m = parameters_.rtk_float_sigma_m;
      break;
    case FixQuality::kDifferential:
      sigma_m = parameters_.differential_sigma_m;
      break;
    case FixQuality::kSingle:
    case FixQuality::kNone:
      break;
  }
  Eigen::Matrix2d R =
      measurement.covariance.value_or(Eigen::Matrix2d::Identity() * square(sigma_m));
  const double lacking = square(parameters_.min_gnss_sigma_m) - least_variance(R);
  if (lacking > 0.0) R.diagonal().array() += lacking;
  return R;
}

Outcome MotionModel::update(FilterState& state, const GnssPosition& measurement) const {
  const double c = std::cos(state.x(kHeading));
  const double s = std::sin(state.x(kHeading));
  const Eigen::Vector2d lever_F(c * parameters_.antenna_x_m - s * parameters_.antenna_y_m,
                                s * parameters_.antenna_x_m + c * parameters_.antenna_y_m);
  Eigen::Matrix<double, 2, kStates> H = Eigen::Matrix<double, 2, kStates>::Zero();
  H(0, kX) = 1.0;
  H(1, kY) = 1.0;
  H(0, kHeading) = -lever_F.y();
  H(1, kHeading) = lever_F.x();
  const Eigen::Matrix2d R = gnss_covariance(measurement);
  const Eigen::Vector2d innovation = measurement.p_FA_m - state.x.head<2>() - lever_F;

  StateCovariance& P = state.P;
  Repeats& repeats = state.repeats;
  Eigen::Matrix<double, kStates, 2> PHt = P * H.transpose();
  Eigen::Matrix2d S = H * PHt + R;
  Outcome outcome = Outcome::kUsed;
  if (innovation.dot(S.inverse() * innovation) > gate_2_) {
    const Eigen::Vector2d change = innovation - repeats.gnss_innovation;
    const bool agrees =
        repeats.gnss > 0 && change.dot((2.0 * R).inverse() * change) <= 2.0 * gate_2_;
    repeats.gnss = agrees ? repeats.gnss + 1 : 1;
    repeats.gnss_innovation = innovation;
    if (repeats.gnss < parameters_.gnss_recovery_repeats) return Outcome::kGated;
    P(kX, kX) += square(innovation.x());
    P(kY, kY) += square(innovation.y());
    P(kHeading, kHeading) += square(parameters_.recovery_heading_sigma_rad);
    PHt = P * H.transpose();
    S = H * PHt + R;
    outcome = Outcome::kRecovered;
  }
  repeats.gnss = 0;
  const Eigen::Matrix<double, kStates, 2> K = PHt * S.inverse();
  state.x += K * innovation;
  state.x(kHeading) = geometry::wrap_angle_rad(state.x(kHeading));
  const StateCovariance A = P - K * PHt.transpose();
  P = A - (A * H.transpose()) * K.transpose() + K * R * K.transpose();
  symmetrize(P);
  return outcome;
}

PoseEstimate MotionModel::estimate(const FilterState& state) {
  PoseEstimate estimate;
  estimate.stamp = state.stamp;
  estimate.X_FB = {state.x(kX), state.x(kY), state.x(kHeading)};
  estimate.covariance = state.P.topLeftCorner<3, 3>();
  estimate.speed_mps = state.x(kSpeed);
  estimate.yaw_rate_radps = state.x(kYawRate);
  estimate.twist_covariance = state.P.block<2, 2>(kSpeed, kSpeed);
  return estimate;
}

}  // namespace furrow::localization
