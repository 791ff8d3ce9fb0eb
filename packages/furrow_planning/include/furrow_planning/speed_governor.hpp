#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_planning/speed_profile.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// How the tool asks the robot for its speed.
struct SpeedGovernorParameters {
  double min_speed_mps = 0.25;
  double speed_step_mps = 0.05;
  double acceleration_mps2 = 0.3;
  double lead_m = 0.05;
  double tolerated_weight = 0.0;
  std::int64_t most_planned_targets = 800;

  void visit(ParameterVisitor& v);
};

/// What a plan would leave for want of time, by x, if the robot drove like this.
using LeftAtSpeeds = std::function<Result<std::span<const LeftTarget>>(const SpeedProfile& speeds)>;

/// What the governor needs to know of the robot and of the plan in force.
struct GovernedRobot {
  double x_m = 0.0;        ///< of the base, in F
  double speed_mps = 0.0;  ///< measured
  /// Sprays up to here are fixed for the speeds decided last: until then it does not accelerate
  /// beyond them.
  double committed_until_x_m = 0.0;
  std::int64_t targets = 0;  ///< that a plan is for, by which the number of plans is bounded
};

/// Decides how fast the robot may drive so that the axes keep up with the weeds ahead, as a tool
/// that asks its tractor for a ground speed. It has the weeds ahead planned for the row's own speed
/// and looks where the plan leaves a weed that a plan for the least speed would not: there, from a
/// lead before the foremost axis meets the weed until the hindmost has passed it, the robot is to
/// be a step slower; and so on, until none is left so. In between the robot brakes and accelerates
/// within its limit. What no speed saves slows nothing. Not thread-safe.
class SpeedGovernor {
 public:
  /// `row_speed_mps`: what the robot drives at where nothing holds it back. `front_m`, `rear_m`: x
  /// of the foremost and of the hindmost axis in the base frame. Throws ConfigError for values out
  /// of range, or a least speed above the row's.
  SpeedGovernor(const SpeedGovernorParameters& parameters, double row_speed_mps, double front_m,
                double rear_m);

  /// Looks at the weeds ahead anew. An error of `left_at`, or a robot whose numbers are not finite,
  /// leaves the speeds as they were.
  Status consider(const GovernedRobot& robot, const LeftAtSpeeds& left_at);

  /// The speed to ask for at this place: the row's before the first look.
  [[nodiscard]] double request_mps(double robot_x_m) const;
  /// How the robot will drive, to plan for: as it is asked, or faster by what the measured speed
  /// was above that at the last look.
  [[nodiscard]] const SpeedProfile& expected() const { return expected_; }

 private:
  void limit_by_promise(const GovernedRobot& robot);
  [[nodiscard]] bool slow_down_for(double weed_x_m, double lead_m);
  void fill(double cap_mps);
  Status find_unsaved(const GovernedRobot& robot, const LeftAtSpeeds& left_at);
  [[nodiscard]] SpeedProfile drivable(const GovernedRobot& robot, double harder) const;
  [[nodiscard]] SpeedProfile with_excess(const SpeedProfile& asked,
                                         const GovernedRobot& robot) const;

  SpeedGovernorParameters parameters_;
  double row_speed_mps_;
  double front_m_;
  double rear_m_;
  std::optional<SpeedProfile> asked_;
  SpeedProfile expected_;
  double from_x_m_ = 0.0;            ///< of the caps
  std::vector<double> caps_mps_;     ///< at equal steps of the robot's x
  std::vector<double> promise_mps_;  ///< likewise
  std::vector<LeftTarget> unsaved_;  ///< left at the least speed as well
  std::vector<LeftTarget> left_;
};

}  // namespace furrow::planning
