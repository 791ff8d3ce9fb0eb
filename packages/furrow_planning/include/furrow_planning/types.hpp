#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace furrow::planning {

// Frames: F is the field frame aligned with the row: x along the travel, y to the left. Robot x is
// the x of the base frame's origin in F; robot y its lateral offset. Positions in metres.

using TargetId = std::int64_t;

/// A weed that may be treated.
struct Target {
  TargetId id = 0;
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();  ///< stem
  double weight = 1.0;    ///< worth of treating it (priority or harmfulness); >= 0
  double radius_m = 0.0;  ///< of the plant; informative
};

/// A target that a plan leaves for want of time.
struct LeftTarget {
  double x_m = 0.0;  ///< in F
  double weight = 0.0;
};

/// A plant that no spray may come near: each spray's centre keeps a distance of footprint radius +
/// protection zone (PlannerParameters) + `zone_m` from the stem.
struct ProtectedPlant {
  TargetId id = 0;
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  double zone_m = 0.0;  ///< in addition to the common protection zone, such as the canopy's radius
};

/// What does not change about a lateral axis. The nozzle's line crosses a target at x_m when the
/// robot's x is x_m - offset_x_m; the nozzle's y in F is the robot's y plus the axis position.
struct AxisSpec {
  double offset_x_m = 0.0;
  double lower_m = -0.695;  ///< axis position
  double upper_m = 0.695;
  double max_velocity_mps = 5.0;
  double max_acceleration_mps2 = 50.0;
};

/// Where an axis can next start from: it rests at `position_m` from the moment on at which the
/// robot's x is `free_from_x_m`.
struct AxisState {
  double position_m = 0.0;
  double free_from_x_m = 0.0;
  bool in_service = true;
  /// Whether a spray was fired at that moment; the margin between stops then holds for the first.
  bool after_spray = false;
};

struct RobotState {
  double x_m = 0.0;
  double y_m = 0.0;
  double speed_mps = 0.5;
};

/// What becomes of a target in a plan. Everything but kTreat says why it is left standing.
enum class Decision : std::uint8_t {
  kTreat,
  kUnreachable,    ///< no axis can be there in time, or others were worth more
  kLowPriority,    ///< weight below the threshold
  kProtectedCrop,  ///< every spray that treats it enters a crop's protection zone
  kOutside,        ///< beyond the span of every axis
  kBehind,         ///< all axes have passed it
  kInvalid,        ///< position or weight not finite, or weight negative
  kDuplicate,      ///< the id was given before; the first one counts
  kAxisFault,      ///< reachable only by axes that are out of service
};
[[nodiscard]] std::string_view to_string(Decision decision);

/// One spray.
struct Stop {
  Eigen::Vector2d aim_F = Eigen::Vector2d::Zero();  ///< centre of the spray on the ground
  double robot_x_m = 0.0;                           ///< robot x at the spray
  double depart_x_m =
      0.0;  ///< robot x at which the axis must have left for this stop at the latest
  double position_m = 0.0;  ///< axis position at the spray
  /// Fired in passing, during the move to the next stop that is not moving. That move then departs
  /// at depart_x_m exactly (the same for both) and runs at its full limits.
  bool moving = false;
  std::uint32_t first_target = 0;  ///< into Plan::treated
  std::uint32_t target_count = 0;
};

struct TargetDecision {
  TargetId id = 0;
  Decision decision = Decision::kUnreachable;
  std::int32_t axis = -1;  ///< kTreat only
};

/// Routes and decisions. Reusing a Plan keeps its memory.
struct Plan {
  std::vector<std::vector<Stop>> routes;  ///< per axis, by robot x
  std::vector<TargetId> treated;          ///< ids in the order of stops; see targets_of()
  std::vector<TargetDecision> decisions;  ///< one for each given target, in the order given
  double weight = 0.0;                    ///< sum over treated targets
  double weight_bound = 0.0;              ///< no plan of this problem can treat more
  double travel_m = 0.0;                  ///< of all axes

  /// The ids treated by a stop, nearest to the spray's centre first.
  [[nodiscard]] std::span<const TargetId> targets_of(const Stop& stop) const {
    return std::span(treated).subspan(stop.first_target, stop.target_count);
  }
  /// Empties the plan, keeping its memory.
  void clear(std::size_t axes);
};

class SpeedProfile;

/// A snapshot to plan for. Does not own what it refers to.
struct PlanningProblem {
  std::span<const Target> targets;
  std::span<const ProtectedPlant> protected_plants;
  std::span<const AxisSpec> axes;
  std::span<const AxisState> states;  ///< one for each axis
  RobotState robot;
  /// How the robot will drive; null: at the constant speed that the parameters name. Not with
  /// fire_while_moving.
  const SpeedProfile* speeds = nullptr;
};

}  // namespace furrow::planning
