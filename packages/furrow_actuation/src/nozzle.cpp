#include "furrow_actuation/nozzle.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::actuation {

void NozzleCalibration::visit(ParameterVisitor& v) {
  v.visit({.name = "open_delay_s",
           .unit = "s",
           .description = "from the command to the first droplets at the nozzle",
           .min = 0.0,
           .max = 0.5},
          open_delay_s);
  v.visit({.name = "close_delay_s",
           .unit = "s",
           .description = "from the command to the last droplets at the nozzle",
           .min = 0.0,
           .max = 0.5},
          close_delay_s);
  v.visit({.name = "exit_speed_mps",
           .unit = "m/s",
           .description = "downward speed of the droplets as they leave",
           .min = 0.0,
           .max = 100.0},
          exit_speed_mps);
  v.visit({.name = "carry",
           .description = "part of the nozzle's ground velocity that the droplets keep in flight",
           .min = 0.0,
           .max = 1.0},
          carry);
  v.visit({.name = "offset_x_m",
           .unit = "m",
           .description = "how far ahead of the computed point a spray lands, in the base frame",
           .min = -0.2,
           .max = 0.2},
          offset_x_m);
  v.visit({.name = "offset_y_m",
           .unit = "m",
           .description = "how far left of the computed point a spray lands, in the base frame",
           .min = -0.2,
           .max = 0.2},
          offset_y_m);
  v.visit({.name = "flow_mlps",
           .unit = "ml/s",
           .description = "flow of the open nozzle",
           .min = 0.0,
           .max = 1000.0},
          flow_mlps);
}

DropletModel NozzleCalibration::droplet(double height_m) const {
  return {fall_time_s(height_m, exit_speed_mps), carry};
}

ValveWindow valve_window(Time emission, double dwell_s, const NozzleCalibration& calibration) {
  const Time open = emission - Duration::seconds(dwell_s / 2.0 + calibration.open_delay_s);
  const Time close = emission + Duration::seconds(dwell_s / 2.0 - calibration.close_delay_s);
  return {open, std::max(close, open + Duration::nanoseconds(1))};
}

void NozzleUseMeter::command(Time time, bool open) {
  if (open == open_) return;
  if (open) {
    opened_ = time;
    ++closed_use_.openings;
  } else {
    closed_use_.open_s += (time - opened_).to_seconds();
  }
  open_ = open;
}

NozzleUse NozzleUseMeter::use(Time time) const {
  NozzleUse use = closed_use_;
  if (open_) use.open_s += (time - opened_).to_seconds();
  use.volume_ml = use.open_s * flow_mlps_;
  return use;
}

}  // namespace furrow::actuation
