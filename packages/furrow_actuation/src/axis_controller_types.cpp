#include "furrow_actuation/axis_controller_types.hpp"

namespace furrow::actuation {

std::string_view to_string(SafetyCause cause) {
  switch (cause) {
    case SafetyCause::kNone:
      return "none";
    case SafetyCause::kEmergencyStop:
      return "emergency_stop";
    case SafetyCause::kPeerLost:
      return "peer_lost";
    case SafetyCause::kPlanStale:
      return "plan_stale";
    case SafetyCause::kOdometryStale:
      return "odometry_stale";
    case SafetyCause::kOdometryInvalid:
      return "odometry_invalid";
    case SafetyCause::kReadingStale:
      return "reading_stale";
    case SafetyCause::kDriveFault:
      return "drive_fault";
    case SafetyCause::kPositionLimit:
      return "position_limit";
    case SafetyCause::kFollowingError:
      return "following_error";
    case SafetyCause::kValveFault:
      return "valve_fault";
    case SafetyCause::kProtectionOverflow:
      return "protection_overflow";
  }
  return "unknown";
}

std::string_view to_string(SkipReason reason) {
  switch (reason) {
    case SkipReason::kNone:
      return "none";
    case SkipReason::kLate:
      return "late";
    case SkipReason::kStale:
      return "stale";
    case SkipReason::kProtectedCrop:
      return "protected_crop";
    case SkipReason::kUnreachable:
      return "unreachable";
    case SkipReason::kFault:
      return "fault";
    case SkipReason::kStanding:
      return "standing";
  }
  return "unknown";
}

std::string_view to_string(ControllerMode mode) {
  switch (mode) {
    case ControllerMode::kWaiting:
      return "waiting";
    case ControllerMode::kRunning:
      return "running";
    case ControllerMode::kSafe:
      return "safe";
  }
  return "unknown";
}

void AxisControllerParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "dwell_s",
           .unit = "s",
           .description = "how long droplets leave the nozzle for one stop",
           .min = 0.001,
           .max = 1.0},
          dwell_s);
  v.visit({.name = "min_off_s",
           .unit = "s",
           .description = "least time between closing the valve and opening it again",
           .min = 0.0,
           .max = 1.0},
          min_off_s);
  v.visit({.name = "late_slack_s",
           .unit = "s",
           .description = "a stop that cannot be reached in time is given up when it is this late",
           .min = 0.0,
           .max = 1.0},
          late_slack_s);
  v.visit({.name = "placement_tolerance_m",
           .unit = "m",
           .description = "a spray predicted to land farther from its aim is not fired",
           .min = 0.0005,
           .max = 0.1},
          placement_tolerance_m);
  v.visit({.name = "protection_radius_m",
           .unit = "m",
           .description = "no spray lands with its centre this near to a protected plant",
           .min = 0.0,
           .max = 0.5},
          protection_radius_m);
  v.visit({.name = "rest_speed_mps",
           .unit = "m/s",
           .description = "but in passing, no drop leaves before the axis is slower than this",
           .min = 0.001,
           .max = 5.0},
          rest_speed_mps);
  v.visit({.name = "max_fire_speed_mps",
           .unit = "m/s",
           .description = "the axis moves no faster than this while the valve is open",
           .min = 0.001,
           .max = 5.0},
          max_fire_speed_mps);
  v.visit({.name = "plan_deadline_s",
           .unit = "s",
           .description = "a plan older than this makes the tool safe",
           .min = 0.01,
           .max = 60.0},
          plan_deadline_s);
  v.visit({.name = "odometry_deadline_s",
           .unit = "s",
           .description = "odometry older than this makes the tool safe",
           .min = 0.005,
           .max = 10.0},
          odometry_deadline_s);
  v.visit({.name = "reading_deadline_s",
           .unit = "s",
           .description = "a drive reading older than this makes the tool safe",
           .min = 0.002,
           .max = 10.0},
          reading_deadline_s);
  v.visit({.name = "max_target_age_s",
           .unit = "s",
           .description = "a stop whose targets were not seen for this long is not sprayed",
           .min = 0.1,
           .max = 600.0},
          max_target_age_s);
  v.visit({.name = "following_error_limit_m",
           .unit = "m",
           .description = "following error that makes the tool safe when it lasts",
           .min = 0.0001,
           .max = 1.0},
          following_error_limit_m);
  v.visit({.name = "following_error_time_s",
           .unit = "s",
           .description = "how long the following error may last",
           .min = 0.0,
           .max = 1.0},
          following_error_time_s);
  v.visit({.name = "position_margin_m",
           .unit = "m",
           .description = "how far beyond its limits the axis may be measured",
           .min = 0.0,
           .max = 0.1},
          position_margin_m);
  v.visit({.name = "dry_run", .description = "everything moves, no valve opens"}, dry_run);
  crossing.visit(v);
}

}  // namespace furrow::actuation
