#include "axis_driver_parameters.hpp"

namespace furrow::components {

void AxisDriverParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
  v.visit({.name = "axis", .description = "joint of the URDF that is driven"}, axis);
  v.visit(
      {.name = "rate_hz", .unit = "Hz", .description = "control loop", .min = 10.0, .max = 5000.0},
      rate_hz);
  v.visit({.name = "state_rate_hz",
           .unit = "Hz",
           .description = "published states",
           .min = 1.0,
           .max = 1000.0},
          state_rate_hz);
  v.visit({.name = "protect_threshold",
           .description = "tracks with at least this crop probability are protected: crops, and "
                          "plants that the planner calls unsure",
           .min = 0.0,
           .max = 1.0},
          protect_threshold);
  v.visit({.name = "protected_range_m",
           .unit = "m",
           .description = "crops this far before and behind the axis are watched",
           .min = 0.1,
           .max = 10.0},
          protected_range_m);
  v.visit({.name = "latch_folder",
           .description = "folder for the causes that are latched, so that a restart keeps them; "
                          "empty: a restart forgets them"},
          latch_folder);
  v.visit({.name = "nozzle_file",
           .description = "calibration with an entry for this axis, as `furrow calibrate` writes "
                          "it; empty: the nozzle_* below"},
          nozzle_file);
  PrefixedVisitor nozzle_visitor(v, "nozzle_");
  nozzle.visit(nozzle_visitor);
  controller.visit(v);
  hardware.visit(v);
}

}  // namespace furrow::components
