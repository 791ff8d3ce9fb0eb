#include "furrow_simulation/sensors.hpp"

#include <cmath>
#include <numbers>

namespace furrow::simulation {
namespace {

constexpr double kGravity_mps2 = 9.80665;

ParameterInfo deviation(std::string name, std::string unit, std::string description) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .description = std::move(description),
          .min = 0.0,
          .max = 100.0};
}

}  // namespace

void WheelOdometryParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "speed_scale",
           .description = "Measured over true speed of the wheels",
           .min = 0.5,
           .max = 2.0},
          speed_scale);
  v.visit(deviation("speed_noise_mps", "m/s", "Standard deviation of the speed"), speed_noise_mps);
  v.visit({.name = "yaw_rate_scale",
           .description = "Measured over true yaw rate",
           .min = 0.5,
           .max = 2.0},
          yaw_rate_scale);
  v.visit(deviation("yaw_rate_noise_radps", "rad/s", "Standard deviation of the yaw rate"),
          yaw_rate_noise_radps);
  v.visit({.name = "yaw_rate_bias_radps",
           .unit = "rad/s",
           .description = "Constant error of the yaw rate",
           .min = -1.0,
           .max = 1.0},
          yaw_rate_bias_radps);
}

WheelOdometry::WheelOdometry(const WheelOdometryParameters& parameters, std::uint64_t seed)
    : parameters_(parameters), random_(seed, "wheel_odometry") {}

WheelReading WheelOdometry::measure(const RobotState& state) {
  return {.time = state.time,
          .speed_mps = parameters_.speed_scale * state.wheel_speed_mps +
                       parameters_.speed_noise_mps * random_.normal(0.0, 1.0),
          .yaw_rate_radps = parameters_.yaw_rate_scale * state.yaw_rate_radps +
                            parameters_.yaw_rate_bias_radps +
                            parameters_.yaw_rate_noise_radps * random_.normal(0.0, 1.0)};
}

void ImuParameters::visit(ParameterVisitor& v) {
  v.visit(deviation("gyro_noise_radps", "rad/s", "Standard deviation of each angular velocity"),
          gyro_noise_radps);
  v.visit({.name = "gyro_bias_radps",
           .unit = "rad/s",
           .description = "Bias of the yaw rate at the start",
           .min = -1.0,
           .max = 1.0},
          gyro_bias_radps);
  v.visit(deviation("gyro_bias_walk_radps_per_sqrt_s", "rad/s/sqrt(s)",
                    "Random walk of the yaw rate's bias"),
          gyro_bias_walk_radps_per_sqrt_s);
  v.visit(deviation("accelerometer_noise_mps2", "m/s2", "Standard deviation of each acceleration"),
          accelerometer_noise_mps2);
  v.visit({.name = "accelerometer_bias_mps2",
           .unit = "m/s2",
           .description = "Constant error along the direction of travel",
           .min = -10.0,
           .max = 10.0},
          accelerometer_bias_mps2);
}

Imu::Imu(const ImuParameters& parameters, std::uint64_t seed)
    : parameters_(parameters), random_(seed, "imu"), bias_radps_(parameters.gyro_bias_radps) {}

ImuReading Imu::measure(const RobotState& state) {
  const double walked_s = last_ && state.time > *last_ ? (state.time - *last_).to_seconds() : 0.0;
  last_ = state.time;
  bias_radps_ +=
      parameters_.gyro_bias_walk_radps_per_sqrt_s * std::sqrt(walked_s) * random_.normal(0.0, 1.0);
  const auto noise = [this](double standard_deviation) {
    const double x = random_.normal(0.0, 1.0);
    const double y = random_.normal(0.0, 1.0);
    const double z = random_.normal(0.0, 1.0);
    return Eigen::Vector3d(standard_deviation * Eigen::Vector3d(x, y, z));
  };
  ImuReading reading;
  reading.time = state.time;
  reading.angular_velocity_B_radps = Eigen::Vector3d(0.0, 0.0, state.yaw_rate_radps + bias_radps_) +
                                     noise(parameters_.gyro_noise_radps);
  // Without sliding sideways, the only lateral acceleration is the centripetal one.
  reading.acceleration_B_mps2 =
      Eigen::Vector3d(state.acceleration_mps2 + parameters_.accelerometer_bias_mps2,
                      state.speed_mps * state.yaw_rate_radps, kGravity_mps2) +
      noise(parameters_.accelerometer_noise_mps2);
  return reading;
}

void GnssParameters::visit(ParameterVisitor& v) {
  const auto place = [](std::string name, std::string description) {
    return ParameterInfo{.name = std::move(name),
                         .unit = "m",
                         .description = std::move(description),
                         .min = -10.0,
                         .max = 10.0};
  };
  const auto rate = [](std::string name, std::string description) {
    return ParameterInfo{.name = std::move(name),
                         .unit = "1/min",
                         .description = std::move(description),
                         .min = 0.0,
                         .max = 600.0};
  };
  const auto span = [](std::string name, std::string description) {
    return ParameterInfo{.name = std::move(name),
                         .unit = "s",
                         .description = std::move(description),
                         .min = 0.01,
                         .max = 3600.0};
  };
  v.visit(place("antenna_x_m", "The antenna in front of the base"), antenna_x_m);
  v.visit(place("antenna_y_m", "The antenna to the left of the base"), antenna_y_m);
  v.visit(deviation("fixed_noise_m", "m", "Standard deviation of each coordinate, fixed"),
          fixed_noise_m);
  v.visit(deviation("float_noise_m", "m", "Standard deviation of each coordinate, float"),
          float_noise_m);
  v.visit(deviation("single_noise_m", "m", "Standard deviation of each coordinate, single"),
          single_noise_m);
  v.visit({.name = "latency_s",
           .unit = "s",
           .description = "From the antenna's position to its arrival",
           .min = 0.0,
           .max = 10.0},
          latency_s);
  v.visit(rate("degraded_per_min", "How often the fix is lost"), degraded_per_min);
  v.visit(span("degraded_mean_s", "Mean time until it is back"), degraded_mean_s);
  v.visit(rate("outages_per_min", "How often nothing is received"), outages_per_min);
  v.visit(span("outage_mean_s", "Mean length of that"), outage_mean_s);
  v.visit(rate("jumps_per_min", "How often the fix is wrong and does not say so"), jumps_per_min);
  v.visit({.name = "jump_m",
           .unit = "m",
           .description = "How far a wrong fix is off",
           .min = 0.0,
           .max = 100.0},
          jump_m);
  v.visit(span("jump_mean_s", "Mean length of a wrong fix"), jump_mean_s);
}

bool Gnss::Episode::update(Time now) {
  began_ = false;
  if (per_min_ <= 0.0) return false;
  if (!scheduled_) end_ = now;
  while (!scheduled_ || end_ <= now) {
    start_ = end_ + Duration::seconds(random_.exponential(60.0 / per_min_));
    end_ = start_ + Duration::seconds(random_.exponential(mean_s_));
    scheduled_ = true;
    entered_ = false;
  }
  if (now < start_) return false;
  began_ = !entered_;
  entered_ = true;
  return true;
}

Gnss::Gnss(const GnssParameters& parameters, std::uint64_t seed)
    : parameters_(parameters),
      random_(seed, "gnss"),
      degraded_(parameters.degraded_per_min, parameters.degraded_mean_s, seed, "gnss_degraded"),
      outage_(parameters.outages_per_min, parameters.outage_mean_s, seed, "gnss_outage"),
      jump_(parameters.jumps_per_min, parameters.jump_mean_s, seed, "gnss_jump") {}

std::optional<GnssReading> Gnss::measure(const RobotState& state) {
  const double noise_x = random_.normal(0.0, 1.0);
  const double noise_y = random_.normal(0.0, 1.0);
  const double direction_rad = random_.uniform(0.0, 2.0 * std::numbers::pi);
  const bool degraded = degraded_.update(state.time);
  const bool jumping = jump_.update(state.time);
  if (jump_.began()) {
    jump_F_m_ =
        parameters_.jump_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
  }
  if (outage_.update(state.time)) return std::nullopt;

  GnssReading reading;
  reading.time = state.time;
  reading.available = state.time + Duration::seconds(parameters_.latency_s);
  reading.quality = GnssQuality::kFixed;
  reading.standard_deviation_m = parameters_.fixed_noise_m;
  if (degraded && degraded_.in_first_half(state.time)) {
    reading.quality = GnssQuality::kSingle;
    reading.standard_deviation_m = parameters_.single_noise_m;
  } else if (degraded) {
    reading.quality = GnssQuality::kFloat;
    reading.standard_deviation_m = parameters_.float_noise_m;
  }
  reading.p_F_m =
      geometry::transform(state.X_FB, {parameters_.antenna_x_m, parameters_.antenna_y_m}) +
      reading.standard_deviation_m * Eigen::Vector2d(noise_x, noise_y);
  if (jumping) reading.p_F_m += jump_F_m_;
  return reading;
}

}  // namespace furrow::simulation
