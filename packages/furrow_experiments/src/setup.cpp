#include "furrow_experiments/setup.hpp"

namespace furrow::experiments {

void SetupParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "axes", .description = "lateral axes, one behind another", .min = 1, .max = 64},
          axes);
  v.visit({.name = "axis_spacing_m",
           .unit = "m",
           .description = "between two axes, along the travel",
           .min = 0.0,
           .max = 10.0},
          axis_spacing_m);
  v.visit({.name = "axis_travel_m",
           .unit = "m",
           .description = "span of each axis, about the middle of the robot",
           .min = 0.01,
           .max = 100.0},
          axis_travel_m);
  v.visit({.name = "axis_velocity_mps",
           .unit = "m/s",
           .description = "greatest velocity of an axis",
           .min = 0.01,
           .max = 100.0},
          axis_velocity_mps);
  v.visit({.name = "axis_acceleration_mps2",
           .unit = "m/s2",
           .description = "greatest acceleration of an axis; for the trapezoid kinematics",
           .min = 0.01,
           .max = 1e4},
          axis_acceleration_mps2);
  v.visit({.name = "frame_period_s",
           .unit = "s",
           .description = "between two observations",
           .min = 0.001,
           .max = 10.0},
          frame_period_s);
  v.visit({.name = "look_ahead_m",
           .unit = "m",
           .description = "how far before the first axis plants are seen",
           .min = 0.0,
           .max = 100.0},
          look_ahead_m);
}

std::vector<planning::AxisSpec> axis_specs(const SetupParameters& setup) {
  std::vector<planning::AxisSpec> specs;
  const double first_m = 0.5 * setup.axis_spacing_m * static_cast<double>(setup.axes - 1);
  for (std::int64_t a = 0; a < setup.axes; ++a) {
    specs.push_back({.offset_x_m = first_m - setup.axis_spacing_m * static_cast<double>(a),
                     .lower_m = -0.5 * setup.axis_travel_m,
                     .upper_m = 0.5 * setup.axis_travel_m,
                     .max_velocity_mps = setup.axis_velocity_mps,
                     .max_acceleration_mps2 = setup.axis_acceleration_mps2});
  }
  return specs;
}

}  // namespace furrow::experiments
