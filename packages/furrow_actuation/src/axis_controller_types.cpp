#include "furrow_actuation/axis_controller_types.hpp"

namespace furrow::actuation {

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
    case SkipReason::kInactive:
      return "inactive";
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
  visit_firing(v);
  crossing.visit(v);
  safety.visit(v);
}

void AxisControllerParameters::visit_firing(ParameterVisitor& v) {
  v.visit({.name = "rest_speed_mps",
           .unit = "m/s",
           .description = "but in passing, no drop leaves before the axis is slower than this",
           .min = 0.001,
           .max = 5.0},
          rest_speed_mps);
  v.visit({.name = "settled_error_m",
           .unit = "m",
           .description =
               "an axis farther from its setpoint is not at rest: no spray, except in passing",
           .min = 0.0001,
           .max = 0.1},
          settled_error_m);
  v.visit({.name = "max_fire_speed_mps",
           .unit = "m/s",
           .description = "the axis moves no faster than this while the valve is open",
           .min = 0.001,
           .max = 5.0},
          max_fire_speed_mps);
  v.visit({.name = "max_target_age_s",
           .unit = "s",
           .description = "a stop with a target that was not seen for this long is not sprayed; "
                          "time that the robot stands does not count",
           .min = 0.1,
           .max = 600.0},
          max_target_age_s);
  v.visit({.name = "reverse_tolerance_m",
           .unit = "m",
           .description = "ground that was passed is not sprayed: after reversing for longer than "
                          "this, the robot drives back first",
           .min = 0.0,
           .max = 0.1},
          reverse_tolerance_m);
  v.visit({.name = "dry_run", .description = "everything moves, no valve opens"}, dry_run);
}

}  // namespace furrow::actuation
