#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"

namespace furrow::simulation {

/// The true motion of the simulated robot. Without noise it follows the row's line exactly.
struct RobotMotionParameters {
  double speed_mps = 0.5;
  /// Speed over time since the start. It is linear in between, and constant before and after. Two
  /// points at one time make a step. Empty: speed_mps throughout. Negative speeds drive backwards.
  std::vector<double> profile_time_s;
  std::vector<double> profile_speed_mps;
  double limit_acceleration_mps2 = 0.5;
  double speed_noise_mps = 0.0;  ///< standard deviation
  double speed_correlation_s = 1.0;
  double yaw_noise_radps = 0.0;  ///< standard deviation of the disturbing yaw rate
  double yaw_correlation_s = 0.5;
  double steering_distance_m = 1.0;
  double slip = 0.0;
  double start_x_m = 0.0;
  double start_y_m = 0.0;
  double start_heading_rad = 0.0;
  void visit(ParameterVisitor& v);
};

/// Frames: F the field, B the robot's base. The base does not slide sideways.
struct RobotState {
  Time time;
  geometry::Pose2 X_FB;
  double speed_mps = 0.0;  ///< over ground, along B's x
  double yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;  ///< along B's x
  double wheel_speed_mps = 0.0;    ///< at the wheels' rim; more than speed_mps when they slip
};

/// The true motion of the base along the line y = 0.
///
/// Ornstein-Uhlenbeck noise disturbs wheel speed and yaw rate. It fades out at low speed, so that a
/// robot that shall stand does stand. Steering brings the base back to the line, critically damped
/// over the steering distance L:
///   curvature = -(y / L^2 + 2 sin(heading) / L)
/// y is clamped to L, and the second term changes its sign when the robot drives backwards.
///
/// Integration uses a fixed grid of 1 ms from the start, with linear speed in between. The path
/// therefore does not depend on the steps of the caller.
class RobotMotion {
 public:
  /// Throws ConfigError for a profile whose lists differ in length or whose times descend, and
  /// for values out of range.
  RobotMotion(const RobotMotionParameters& parameters, std::uint64_t seed, Time start = Time());

  [[nodiscard]] const RobotState& state() const { return state_; }
  /// @pre dt >= 0.
  const RobotState& step(Duration dt);
  /// Does nothing when `time` is past already.
  const RobotState& advance_to(Time time);

  /// Limits the magnitude of the command to `limit_mps`; nullopt ends the limit. The command
  /// approaches its new value by limit_acceleration_mps2. Before the first limit, the acceleration
  /// is that of the profile. @pre finite, >= 0.
  void limit_speed(std::optional<double> limit_mps) { asked_limit_mps_ = limit_mps; }

 private:
  [[nodiscard]] double limited(double command_mps);
  [[nodiscard]] double commanded_speed_mps(double since_start_s) const;
  void begin_cell();
  [[nodiscard]] RobotState within_cell(Duration since_grid) const;

  RobotMotionParameters parameters_;
  Random speed_random_;
  Random yaw_random_;
  Time start_;
  std::optional<double> asked_limit_mps_;
  std::optional<double> limit_mps_;  ///< in force; approaches asked_limit_mps_
  double speed_noise_mps_ = 0.0;
  double yaw_noise_radps_ = 0.0;
  RobotState grid_;  ///< at the last grid time, with the inputs of the cell that it begins
  RobotState state_;
};

}  // namespace furrow::simulation
