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

/// Targets that a plan at these speeds leaves for lack of time, by x.
using LeftAtSpeeds = std::function<Result<std::span<const LeftTarget>>(const SpeedProfile& speeds)>;

/// State of the robot and of the current plan, as the governor needs it.
struct GovernedRobot {
  double x_m = 0.0;        ///< of the base, in F
  double speed_mps = 0.0;  ///< measured
  /// Sprays up to here are fixed for the speeds decided last; the robot does not exceed them there.
  double committed_until_x_m = 0.0;
  std::int64_t targets = 0;  ///< in a plan; bounds the number of plans
};

/// Requests a robot speed at which the axes keep up with the weeds ahead, as an implement that
/// requests a ground speed from its tractor. Not thread-safe.
///
/// The governor plans the weeds ahead at the row speed. A weed is saved by a lower speed if that
/// plan leaves it and a plan at the minimum speed treats it. For such a weed the speed is lowered
/// by one step, from a lead before the foremost axis reaches it until the rearmost axis has passed
/// it. This repeats until no such weed is left. Between the steps the robot brakes and accelerates
/// within its limit. A weed that no speed saves does not lower the speed.
class SpeedGovernor {
 public:
  /// `row_speed_mps`: speed where no weed requires a lower one. `front_m`, `rear_m`: x of the
  /// foremost and of the rearmost axis in the base frame. Throws ConfigError for values out of
  /// range, or a minimum speed above the row speed.
  SpeedGovernor(const SpeedGovernorParameters& parameters, double row_speed_mps, double front_m,
                double rear_m);

  /// Decides the speeds again. An error of `left_at` or a non-finite robot state keeps the speeds.
  Status consider(const GovernedRobot& robot, const LeftAtSpeeds& left_at);

  /// The speed to request at this place; the row speed before the first consider().
  [[nodiscard]] double request_mps(double robot_x_m) const;
  /// The expected speed, for planning: the requested one, plus the excess of the measured speed at
  /// the last consider().
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
