#include "furrow_localization/odometry_integrator.hpp"
#include "furrow_localization/pose_filter.hpp"

namespace furrow::localization {

namespace {

/// Parameters of both estimators.
template <class Parameters>
void visit_start_pose(Parameters& p, ParameterVisitor& v) {
  v.visit({.name = "initial_x_m",
           .unit = "m",
           .description = "where the robot starts, in the field frame",
           .min = -1e6,
           .max = 1e6},
          p.initial_x_m);
  v.visit({.name = "initial_y_m",
           .unit = "m",
           .description = "where the robot starts, in the field frame",
           .min = -1e6,
           .max = 1e6},
          p.initial_y_m);
  v.visit({.name = "initial_heading_rad",
           .unit = "rad",
           .description = "heading at the start, from the field's x",
           .min = -3.1416,
           .max = 3.1416},
          p.initial_heading_rad);
}

template <class Parameters>
void visit_bounds(Parameters& p, ParameterVisitor& v) {
  v.visit({.name = "history_measurements",
           .description = "greatest number of measurements kept",
           .min = 2,
           .max = 100000},
          p.history_measurements);
  v.visit({.name = "max_extrapolation_s",
           .unit = "s",
           .description = "how far beyond the newest measurement a pose is given",
           .min = 0.0,
           .max = 60.0},
          p.max_extrapolation_s);
}

template <class Parameters>
void visit_odometry_timeout(Parameters& p, ParameterVisitor& v) {
  v.visit({.name = "odometry_timeout_s",
           .unit = "s",
           .description = "age of odometry from which on the health is degraded",
           .min = 0.0,
           .max = 60.0},
          p.odometry_timeout_s);
}

template <class Parameters>
void visit_position_sigmas(Parameters& p, ParameterVisitor& v) {
  v.visit({.name = "degraded_position_sigma_m",
           .unit = "m",
           .description = "standard deviation of position from which on the health is degraded",
           .min = 0.0,
           .max = 1e4},
          p.degraded_position_sigma_m);
  v.visit({.name = "lost_position_sigma_m",
           .unit = "m",
           .description = "standard deviation of position from which on the robot is lost",
           .min = 0.0,
           .max = 1e4},
          p.lost_position_sigma_m);
}

void visit_start(PoseFilterParameters& p, ParameterVisitor& v) {
  visit_start_pose(p, v);
  v.visit({.name = "initial_position_sigma_m",
           .unit = "m",
           .description = "standard deviation of the start in x and in y",
           .min = 1e-4,
           .max = 1e4},
          p.initial_position_sigma_m);
  v.visit({.name = "initial_heading_sigma_rad",
           .unit = "rad",
           .description = "standard deviation of the heading at the start",
           .min = 1e-4,
           .max = 3.1416},
          p.initial_heading_sigma_rad);
  v.visit({.name = "initial_gyro_bias_sigma_radps",
           .unit = "rad/s",
           .description = "standard deviation of the gyroscope's bias",
           .min = 1e-6,
           .max = 1.0},
          p.initial_gyro_bias_sigma_radps);
  v.visit({.name = "initial_speed_scale_sigma",
           .description = "standard deviation of the error of the wheels' scale",
           .min = 1e-6,
           .max = 0.5},
          p.initial_speed_scale_sigma);
  v.visit(
      {.name = "initial_wheel_curvature_sigma_radpm",
       .unit = "rad/m",
       .description = "standard deviation of the turn that the wheels report per metre straight on",
       .min = 1e-6,
       .max = 1.0},
      p.initial_wheel_curvature_sigma_radpm);
}

void visit_motion(PoseFilterParameters& p, ParameterVisitor& v) {
  v.visit({.name = "acceleration_sigma",
           .unit = "m/s/sqrt(s)",
           .description = "random walk of the speed",
           .min = 1e-4,
           .max = 100.0},
          p.acceleration_sigma);
  v.visit({.name = "yaw_acceleration_sigma",
           .unit = "rad/s/sqrt(s)",
           .description = "random walk of the yaw rate",
           .min = 1e-4,
           .max = 100.0},
          p.yaw_acceleration_sigma);
  v.visit({.name = "slip_sigma_m_per_sqrt_s",
           .unit = "m/sqrt(s)",
           .description = "random walk of the position beyond what the wheels see",
           .min = 0.0,
           .max = 1.0},
          p.slip_sigma_m_per_sqrt_s);
  v.visit({.name = "gyro_bias_walk",
           .unit = "rad/s/sqrt(s)",
           .description = "random walk of the gyroscope's bias",
           .min = 0.0,
           .max = 1.0},
          p.gyro_bias_walk);
  v.visit({.name = "speed_scale_walk",
           .unit = "1/sqrt(s)",
           .description = "random walk of the wheels' scale",
           .min = 0.0,
           .max = 1.0},
          p.speed_scale_walk);
  v.visit({.name = "wheel_curvature_walk",
           .unit = "rad/m/sqrt(s)",
           .description = "random walk of the wheels' curvature",
           .min = 0.0,
           .max = 1.0},
          p.wheel_curvature_walk);
}

void visit_gnss(PoseFilterParameters& p, ParameterVisitor& v) {
  v.visit({.name = "antenna_x_m",
           .unit = "m",
           .description = "GNSS antenna in the base frame, forward",
           .min = -10.0,
           .max = 10.0},
          p.antenna_x_m);
  v.visit({.name = "antenna_y_m",
           .unit = "m",
           .description = "GNSS antenna in the base frame, to the left",
           .min = -10.0,
           .max = 10.0},
          p.antenna_y_m);
  v.visit({.name = "rtk_fixed_sigma_m",
           .unit = "m",
           .description = "standard deviation of an RTK fix without a covariance of its own",
           .min = 1e-4,
           .max = 100.0},
          p.rtk_fixed_sigma_m);
  v.visit({.name = "rtk_float_sigma_m",
           .unit = "m",
           .description = "likewise with float ambiguities",
           .min = 1e-4,
           .max = 100.0},
          p.rtk_float_sigma_m);
  v.visit({.name = "differential_sigma_m",
           .unit = "m",
           .description = "likewise with differential corrections",
           .min = 1e-4,
           .max = 100.0},
          p.differential_sigma_m);
  v.visit({.name = "single_sigma_m",
           .unit = "m",
           .description = "likewise without corrections",
           .min = 1e-4,
           .max = 100.0},
          p.single_sigma_m);
  v.visit({.name = "min_gnss_sigma_m",
           .unit = "m",
           .description = "least standard deviation that a GNSS measurement is believed",
           .min = 0.0,
           .max = 100.0},
          p.min_gnss_sigma_m);
}

void visit_gates(PoseFilterParameters& p, ParameterVisitor& v) {
  v.visit({.name = "use_odometry", .description = "whether wheel odometry is used"},
          p.use_odometry);
  v.visit({.name = "use_imu", .description = "whether the gyroscope is used"}, p.use_imu);
  v.visit({.name = "use_gnss", .description = "whether GNSS is used"}, p.use_gnss);
  v.visit({.name = "gate_probability",
           .description = "share of good measurements that the gates let in",
           .min = 0.5,
           .max = 0.999999},
          p.gate_probability);
  v.visit({.name = "gnss_recovery_repeats",
           .description = "GNSS positions in a row that agree with each other and move the state",
           .min = 2,
           .max = 1000},
          p.gnss_recovery_repeats);
  v.visit({.name = "rate_recovery_repeats",
           .description = "rates in a row that contradict the state and move it",
           .min = 2,
           .max = 1000},
          p.rate_recovery_repeats);
  v.visit({.name = "recovery_heading_sigma_rad",
           .unit = "rad",
           .description = "standard deviation added to the heading when GNSS moves the state",
           .min = 0.0,
           .max = 3.1416},
          p.recovery_heading_sigma_rad);
}

void visit_history(PoseFilterParameters& p, ParameterVisitor& v) {
  v.visit({.name = "history_s",
           .unit = "s",
           .description = "how late a measurement may come",
           .min = 0.0,
           .max = 60.0},
          p.history_s);
  visit_bounds(p, v);
  v.visit({.name = "max_jump_ahead_s",
           .unit = "s",
           .description = "greatest step ahead of a stamp that is believed at once",
           .min = 0.1,
           .max = 1e6},
          p.max_jump_ahead_s);
  visit_odometry_timeout(p, v);
  v.visit({.name = "gnss_timeout_s",
           .unit = "s",
           .description = "age of GNSS from which on the health is degraded",
           .min = 0.0,
           .max = 600.0},
          p.gnss_timeout_s);
  visit_position_sigmas(p, v);
}

}  // namespace

void PoseFilterParameters::visit(ParameterVisitor& v) {
  visit_start(*this, v);
  visit_motion(*this, v);
  visit_gnss(*this, v);
  visit_gates(*this, v);
  visit_history(*this, v);
}

void OdometryIntegratorParameters::visit(ParameterVisitor& v) {
  visit_start_pose(*this, v);
  v.visit({.name = "history_s",
           .unit = "s",
           .description = "how far back a pose is given",
           .min = 0.0,
           .max = 60.0},
          history_s);
  visit_bounds(*this, v);
  v.visit({.name = "max_gap_s",
           .unit = "s",
           .description = "longest gap between measurements that is driven across",
           .min = 0.01,
           .max = 60.0},
          max_gap_s);
  visit_odometry_timeout(*this, v);
  visit_position_sigmas(*this, v);
}

}  // namespace furrow::localization
