#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_actuation/bounded_vector.hpp"
#include "furrow_actuation/crossing.hpp"
#include "furrow_actuation/tool_safety.hpp"
#include "furrow_core/parameters.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation {

inline constexpr std::size_t kMaxStopTargets = 16;
inline constexpr std::size_t kMaxPlanStops = 64;
inline constexpr std::size_t kMaxProtectedPlants = 512;
inline constexpr std::size_t kMaxControllerEvents = 48;

using TargetIds = BoundedVector<std::int64_t, kMaxStopTargets>;

/// One spray that the plan asks of this axis.
struct PlannedStop {
  std::int64_t stop_id = 0;  ///< of this plan; targets, not stops, are recognized in later plans
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();  ///< where the middle of the spray shall land
  TargetIds targets;                              ///< the tracks that it treats, at least one
  Time intended;                                  ///< when the plan means it to land; gives order
  Time observed;  ///< the newest view of that target of the stop that was not seen for longest
  bool fire_while_moving = false;  ///< sprayed in passing, on the way to the stop after it
};

/// A crop, or whatever else must not be sprayed.
struct ProtectedPlant {
  std::int64_t id = 0;
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
};

/// Why a stop was not sprayed, or cut short.
enum class SkipReason {
  kNone,
  kLate,           ///< the axis could not be there in time
  kStale,          ///< its targets were not seen for too long
  kProtectedCrop,  ///< too near a protected plant, by the newest tracks
  kUnreachable,    ///< beyond the axis' reach
  kFault,          ///< the tool was in the safe state, or not running yet
  kStanding,       ///< the robot stood or reversed while spraying
  kInactive,       ///< the tool was raised or switched off
};
[[nodiscard]] std::string_view to_string(SkipReason reason);

enum class ControllerEventKind {
  kSprayOpened,
  kSprayClosed,  ///< reason not kNone: cut short
  kStopSkipped,
  kSafeState,     ///< the safe state was entered, or a further cause was latched
  kReset,         ///< a latched cause was reset
  kResetRefused,  ///< the cause was not gone when its reset was asked for
};

struct ControllerEvent {
  ControllerEventKind kind = ControllerEventKind::kSafeState;
  Time time;                 ///< of the command or decision
  std::int64_t stop_id = 0;  ///< sprays and skips
  TargetIds targets;         ///< sprays and skips
  Eigen::Vector2d aim_F = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();  ///< sprays: where its middle lands, as computed
  Time landing;                                   ///< sprays: when its middle lands, as computed
  double q_m = 0.0;                               ///< sprays: the axis' measured position
  SkipReason reason = SkipReason::kNone;
  SafetyCause cause = SafetyCause::kNone;
  bool dry_run = false;  ///< a spray that was only acted out
};

using ControllerEvents = BoundedVector<ControllerEvent, kMaxControllerEvents>;

struct AxisControllerParameters {
  double dwell_s = 0.010;
  double min_off_s = 0.004;
  double late_slack_s = 0.010;
  double placement_tolerance_m = 0.008;
  double protection_radius_m = 0.030;
  double rest_speed_mps = 0.05;
  double settled_error_m = 0.001;
  double max_fire_speed_mps = 0.5;
  double max_target_age_s = 30.0;  ///< of motion: time that the robot stands does not count
  double reverse_tolerance_m = 0.002;
  bool dry_run = false;
  ToolSafetyParameters safety;
  CrossingParameters crossing;

  void visit(ParameterVisitor& v);

 private:
  void visit_firing(ParameterVisitor& v);
};

/// What the loop writes, in this order: first the valve, then the axis.
struct ControllerOutput {
  bool valve_open = false;
  AxisCommand axis;
  ControllerMode mode = ControllerMode::kWaiting;
  SafetyCause cause = SafetyCause::kNone;  ///< the first of those that are latched
  Time cause_time;
  ControllerEvents events;
};

}  // namespace furrow::actuation
