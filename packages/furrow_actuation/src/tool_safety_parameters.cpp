#include "furrow_actuation/tool_safety.hpp"

namespace furrow::actuation {
namespace {

ParameterInfo deadline(std::string name, std::string description, double min_s, double max_s) {
  return {.name = std::move(name),
          .unit = "s",
          .description = std::move(description),
          .min = min_s,
          .max = max_s};
}

}  // namespace

std::string_view to_string(ControllerMode mode) {
  switch (mode) {
    case ControllerMode::kWaiting:
      return "waiting";
    case ControllerMode::kRunning:
      return "running";
    case ControllerMode::kSafe:
      return "safe";
    case ControllerMode::kInactive:
      return "inactive";
  }
  return "unknown";
}

void ToolSafetyParameters::visit(ParameterVisitor& v) {
  v.visit(deadline("plan_deadline_s", "without a plan for longer the tool enters the safe state",
                   0.01, 60.0),
          plan_deadline_s);
  v.visit(
      deadline("tracks_deadline_s",
               "tracks whose newest image is older do not protect crops: safe state", 0.05, 60.0),
      tracks_deadline_s);
  v.visit(deadline("odometry_deadline_s", "odometry that is older leads to the safe state", 0.005,
                   10.0),
          odometry_deadline_s);
  v.visit(
      deadline(
          "odometry_delay_limit_s",
          "odometry that arrives farther from its stamp is not used, since its clock may be off",
          0.001, 10.0),
      odometry_delay_limit_s);
  v.visit(deadline("heartbeat_deadline_s",
                   "without a heartbeat of the planner for longer: safe state", 0.01, 10.0),
          heartbeat_deadline_s);
  v.visit(deadline("reading_deadline_s", "a drive reading that is older leads to the safe state",
                   0.002, 10.0),
          reading_deadline_s);
  v.visit(deadline("valve_deadline_s",
                   "a valve that does not confirm to be shut for longer is a fault", 0.0, 1.0),
          valve_deadline_s);
  v.visit(
      deadline("loop_deadline_s",
               "a control loop that did not run for longer leads to the safe state", 0.01, 10.0),
      loop_deadline_s);
  v.visit({.name = "following_error_limit_m",
           .unit = "m",
           .description = "following error that leads to the safe state when it lasts",
           .min = 0.0001,
           .max = 1.0},
          following_error_limit_m);
  v.visit(deadline("following_error_time_s", "how long the following error may last", 0.0, 1.0),
          following_error_time_s);
  v.visit({.name = "position_margin_m",
           .unit = "m",
           .description = "how far beyond its limits the axis may be measured",
           .min = 0.0,
           .max = 0.1},
          position_margin_m);
}

}  // namespace furrow::actuation
