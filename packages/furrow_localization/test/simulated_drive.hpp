#pragma once

#include <cmath>
#include <cstdint>
#include <variant>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_localization/pose_filter.hpp"

namespace furrow::localization::test {

using AnyMeasurement = std::variant<WheelOdometry, ImuYawRate, GnssPosition>;

struct TruePose {
  Time stamp;
  geometry::Pose2 X_FB;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

struct DriveOptions {
  double duration_s = 60.0;
  double speed_mps = 0.5;
  double speed_walk = 0.1;      ///< m/s per sqrt(s), pulled back to speed_mps
  double yaw_rate_walk = 0.05;  ///< rad/s per sqrt(s), steered back to the row
  double wheel_scale_sigma = 0.01;
  double wheel_curvature_sigma = 0.005;
  double wheel_speed_sigma = 0.01;
  double wheel_yaw_rate_sigma = 0.02;
  double gyro_bias_sigma = 0.005;
  double gyro_sigma = 0.005;
  double gnss_sigma_m = 0.010;
  int gnss_hz = 10;
  double antenna_x_m = 0.3;
  double antenna_y_m = 0.1;
};

/// A robot that keeps to the row y = 0, and what its sensors report, each list in the order of
/// time: wheels at 50 Hz, gyroscope at 100 Hz, GNSS at gnss_hz. Truth every 10 ms. Simulated.
struct Drive {
  std::vector<TruePose> truth;
  std::vector<AnyMeasurement> measurements;
};

inline Time stamp_of(const AnyMeasurement& measurement) {
  return std::visit([](const auto& m) { return m.stamp; }, measurement);
}

inline Drive simulate_drive(std::uint64_t seed, const DriveOptions& o = {}) {
  Random motion(seed, "motion");
  Random wheels(seed, "wheels");
  Random gyro(seed, "gyro");
  Random gnss(seed, "gnss");
  const double scale = wheels.normal(0.0, o.wheel_scale_sigma);
  const double curvature = wheels.normal(0.0, o.wheel_curvature_sigma);
  const double bias = gyro.normal(0.0, o.gyro_bias_sigma);

  Drive drive;
  TruePose now;
  now.speed_mps = o.speed_mps;
  constexpr int kStepsPerTick = 10;  // of 1 ms
  const int ticks = static_cast<int>(std::lround(o.duration_s * 100.0));
  for (int tick = 0; tick <= ticks; ++tick) {
    now.stamp = Time() + Duration::milliseconds(10) * tick;
    drive.truth.push_back(now);
    if (tick % 2 == 0) {
      WheelOdometry m;
      m.stamp = now.stamp;
      m.speed_mps = (1.0 + scale) * now.speed_mps + wheels.normal(0.0, o.wheel_speed_sigma);
      m.yaw_rate_radps = now.yaw_rate_radps + curvature * now.speed_mps +
                         wheels.normal(0.0, o.wheel_yaw_rate_sigma);
      m.speed_variance = o.wheel_speed_sigma * o.wheel_speed_sigma;
      m.yaw_rate_variance = o.wheel_yaw_rate_sigma * o.wheel_yaw_rate_sigma;
      drive.measurements.emplace_back(m);
    }
    ImuYawRate m;
    m.stamp = now.stamp;
    m.yaw_rate_radps = now.yaw_rate_radps + bias + gyro.normal(0.0, o.gyro_sigma);
    m.yaw_rate_variance = o.gyro_sigma * o.gyro_sigma;
    drive.measurements.emplace_back(m);
    if (tick % (100 / o.gnss_hz) == 0) {
      GnssPosition fix;
      fix.stamp = now.stamp;
      fix.p_FA_m = geometry::transform(now.X_FB, {o.antenna_x_m, o.antenna_y_m});
      fix.p_FA_m.x() += gnss.normal(0.0, o.gnss_sigma_m);
      fix.p_FA_m.y() += gnss.normal(0.0, o.gnss_sigma_m);
      fix.covariance = Eigen::Matrix2d::Identity() * (o.gnss_sigma_m * o.gnss_sigma_m);
      drive.measurements.emplace_back(fix);
    }
    for (int i = 0; i < kStepsPerTick; ++i) {
      constexpr double kDt_s = 1e-3;
      now.X_FB.x_m += now.speed_mps * std::cos(now.X_FB.heading_rad) * kDt_s;
      now.X_FB.y_m += now.speed_mps * std::sin(now.X_FB.heading_rad) * kDt_s;
      now.X_FB.heading_rad += now.yaw_rate_radps * kDt_s;
      now.speed_mps += 2.0 * (o.speed_mps - now.speed_mps) * kDt_s +
                       motion.normal(0.0, o.speed_walk * std::sqrt(kDt_s));
      const double steering =
          -4.0 * now.X_FB.y_m - 4.0 * now.X_FB.heading_rad - 4.0 * now.yaw_rate_radps;
      now.yaw_rate_radps +=
          steering * kDt_s + motion.normal(0.0, o.yaw_rate_walk * std::sqrt(kDt_s));
    }
  }
  return drive;
}

/// The filter's parameters for such a drive, with the true start known to 50 mm and 3 degrees.
inline PoseFilterParameters parameters_for(const DriveOptions& o) {
  PoseFilterParameters parameters;
  parameters.initial_position_sigma_m = 0.05;
  parameters.initial_heading_sigma_rad = 0.05;
  parameters.antenna_x_m = o.antenna_x_m;
  parameters.antenna_y_m = o.antenna_y_m;
  return parameters;
}

inline Outcome add(PoseEstimator& estimator, const AnyMeasurement& measurement) {
  return std::visit([&](const auto& m) { return estimator.add(m); }, measurement);
}

}  // namespace furrow::localization::test
