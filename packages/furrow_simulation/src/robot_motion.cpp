#include "furrow_simulation/robot_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "furrow_core/error.hpp"

namespace furrow::simulation {
namespace {

constexpr Duration kGrid = Duration::milliseconds(1);

void check(const RobotMotionParameters& parameters) {
  validate_parameters(parameters, {"robot motion", 0});
  if (parameters.profile_time_s.size() != parameters.profile_speed_mps.size()) {
    throw ConfigError(
        "robot motion: profile_time_s and profile_speed_mps must be of the same length");
  }
  if (!std::is_sorted(parameters.profile_time_s.begin(), parameters.profile_time_s.end())) {
    throw ConfigError("robot motion: profile_time_s must not descend");
  }
}

/// The next value of an Ornstein-Uhlenbeck process of the given stationary deviation, exactly
/// (Gillespie 1996).
double next_noise(double value, double deviation, double correlation_s, Random& random) {
  const double keep = std::exp(-kGrid.to_seconds() / correlation_s);
  return value * keep + deviation * std::sqrt(1.0 - keep * keep) * random.normal(0.0, 1.0);
}

void visit_speed(RobotMotionParameters& p, ParameterVisitor& v) {
  v.visit({.name = "speed_mps",
           .unit = "m/s",
           .description = "Speed of the wheels, where no profile is given",
           .min = -5.0,
           .max = 5.0},
          p.speed_mps);
  v.visit({.name = "profile_time_s",
           .unit = "s",
           .description = "Times of the speed profile since the start; empty: constant speed",
           .min = 0.0,
           .max = 1e6},
          p.profile_time_s);
  v.visit({.name = "profile_speed_mps",
           .unit = "m/s",
           .description = "Speeds at profile_time_s, linear in between; two at one time: a step",
           .min = -5.0,
           .max = 5.0},
          p.profile_speed_mps);
  v.visit({.name = "limit_acceleration_mps2",
           .unit = "m/s2",
           .description = "Acceleration towards a requested speed limit, and back from it",
           .min = 0.01,
           .max = 20.0},
          p.limit_acceleration_mps2);
}

void visit_noise_and_steering(RobotMotionParameters& p, ParameterVisitor& v) {
  v.visit({.name = "speed_noise_mps",
           .unit = "m/s",
           .description = "Standard deviation of the speed about its command",
           .min = 0.0,
           .max = 1.0},
          p.speed_noise_mps);
  v.visit({.name = "speed_correlation_s",
           .unit = "s",
           .description = "Correlation time of the speed's noise",
           .min = 0.001,
           .max = 1000.0},
          p.speed_correlation_s);
  v.visit({.name = "yaw_noise_radps",
           .unit = "rad/s",
           .description = "Standard deviation of the yaw rate that disturbs the steering",
           .min = 0.0,
           .max = 1.0},
          p.yaw_noise_radps);
  v.visit({.name = "yaw_correlation_s",
           .unit = "s",
           .description = "Correlation time of the yaw rate's noise",
           .min = 0.001,
           .max = 1000.0},
          p.yaw_correlation_s);
  v.visit({.name = "steering_distance_m",
           .unit = "m",
           .description = "Distance over which steering brings the robot back to the row's line",
           .min = 0.1,
           .max = 100.0},
          p.steering_distance_m);
}

void visit_start(RobotMotionParameters& p, ParameterVisitor& v) {
  v.visit({.name = "slip",
           .description = "Part of the wheels' speed that does not reach the ground",
           .min = 0.0,
           .max = 0.9},
          p.slip);
  v.visit({.name = "start_x_m",
           .unit = "m",
           .description = "Start of the base along the row",
           .min = -1e5,
           .max = 1e5},
          p.start_x_m);
  v.visit({.name = "start_y_m",
           .unit = "m",
           .description = "Start of the base beside the line of the row, left positive",
           .min = -10.0,
           .max = 10.0},
          p.start_y_m);
  v.visit({.name = "start_heading_rad",
           .unit = "rad",
           .description = "Heading at the start, counter-clockwise from the row",
           .min = -std::numbers::pi,
           .max = std::numbers::pi},
          p.start_heading_rad);
}

}  // namespace

void RobotMotionParameters::visit(ParameterVisitor& v) {
  visit_speed(*this, v);
  visit_noise_and_steering(*this, v);
  visit_start(*this, v);
}

RobotMotion::RobotMotion(const RobotMotionParameters& parameters, std::uint64_t seed, Time start)
    : parameters_(parameters),
      speed_random_(seed, "robot_speed"),
      yaw_random_(seed, "robot_yaw"),
      start_(start) {
  check(parameters);
  speed_noise_mps_ = parameters.speed_noise_mps * speed_random_.normal(0.0, 1.0);
  yaw_noise_radps_ = parameters.yaw_noise_radps * yaw_random_.normal(0.0, 1.0);
  grid_.time = start;
  grid_.X_FB = {parameters.start_x_m, parameters.start_y_m, parameters.start_heading_rad};
  grid_.wheel_speed_mps = commanded_speed_mps(0.0) + speed_noise_mps_;
  grid_.speed_mps = grid_.wheel_speed_mps * (1.0 - parameters.slip);
  begin_cell();
  state_ = grid_;
}

double RobotMotion::commanded_speed_mps(double since_start_s) const {
  const std::vector<double>& times = parameters_.profile_time_s;
  const std::vector<double>& speeds = parameters_.profile_speed_mps;
  if (times.empty()) return parameters_.speed_mps;
  const auto after = std::upper_bound(times.begin(), times.end(), since_start_s);
  if (after == times.begin()) return speeds.front();
  if (after == times.end()) return speeds.back();
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double fraction = (since_start_s - times[i - 1]) / (times[i] - times[i - 1]);
  return std::lerp(speeds[i - 1], speeds[i], fraction);
}

double RobotMotion::limited(double command_mps) {
  const double own_mps = std::abs(command_mps);
  if (!limit_mps_) {
    if (!asked_limit_mps_) return command_mps;
    limit_mps_ = own_mps;
  }
  const double change_mps = parameters_.limit_acceleration_mps2 * kGrid.to_seconds();
  const double aim_mps = std::min(asked_limit_mps_.value_or(own_mps), own_mps);
  limit_mps_ = std::clamp(aim_mps, *limit_mps_ - change_mps, *limit_mps_ + change_mps);
  const double limit_mps = *limit_mps_;
  if (!asked_limit_mps_ && limit_mps >= own_mps) limit_mps_.reset();
  return std::clamp(command_mps, -limit_mps, limit_mps);
}

void RobotMotion::begin_cell() {
  speed_noise_mps_ = next_noise(speed_noise_mps_, parameters_.speed_noise_mps,
                                parameters_.speed_correlation_s, speed_random_);
  yaw_noise_radps_ = next_noise(yaw_noise_radps_, parameters_.yaw_noise_radps,
                                parameters_.yaw_correlation_s, yaw_random_);
  const double command_mps =
      limited(commanded_speed_mps((grid_.time + kGrid - start_).to_seconds()));
  // Brakes hold a robot that is to stand: the disturbances fade out below a crawl.
  constexpr double kCrawl_mps = 0.05;
  const double disturbed = std::min(1.0, std::abs(command_mps) / kCrawl_mps);
  const double next_wheel_mps = command_mps + disturbed * speed_noise_mps_;
  const double next_speed_mps = next_wheel_mps * (1.0 - parameters_.slip);
  grid_.acceleration_mps2 = (next_speed_mps - grid_.speed_mps) / kGrid.to_seconds();

  const double mean_speed_mps = (grid_.speed_mps + next_speed_mps) / 2;
  const double reach_m = parameters_.steering_distance_m;
  const double offset_m = std::clamp(grid_.X_FB.y_m, -reach_m, reach_m);
  const double ahead = std::copysign(1.0, mean_speed_mps);
  const double curvature =
      -(offset_m / (reach_m * reach_m) + 2.0 * ahead * std::sin(grid_.X_FB.heading_rad) / reach_m);
  grid_.yaw_rate_radps = curvature * mean_speed_mps + disturbed * yaw_noise_radps_;
}

RobotState RobotMotion::within_cell(Duration since_grid) const {
  const double s = since_grid.to_seconds();
  RobotState state = grid_;
  state.time = grid_.time + since_grid;
  state.speed_mps = grid_.speed_mps + grid_.acceleration_mps2 * s;
  state.wheel_speed_mps = state.speed_mps / (1.0 - parameters_.slip);
  const double distance_m = grid_.speed_mps * s + grid_.acceleration_mps2 * s * s / 2;
  const double turn_rad = grid_.yaw_rate_radps * s;
  // The chord of an arc, in the direction of its middle; in a cell the arc's own shortening
  // (turn^2 / 24) is below 1e-8 of it.
  const double direction_rad = grid_.X_FB.heading_rad + turn_rad / 2;
  state.X_FB.x_m += distance_m * std::cos(direction_rad);
  state.X_FB.y_m += distance_m * std::sin(direction_rad);
  state.X_FB.heading_rad = geometry::wrap_angle_rad(grid_.X_FB.heading_rad + turn_rad);
  return state;
}

const RobotState& RobotMotion::step(Duration dt) {
  return advance_to(state_.time + dt);
}

const RobotState& RobotMotion::advance_to(Time time) {
  if (time <= state_.time) return state_;
  while (grid_.time + kGrid <= time) {
    grid_ = within_cell(kGrid);
    begin_cell();
  }
  state_ = within_cell(time - grid_.time);
  return state_;
}

}  // namespace furrow::simulation
