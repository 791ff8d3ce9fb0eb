#pragma once

#include <cstdint>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::experiments {

/// The machine and the stream of observations of an experiment. The defaults are the paper's robot.
struct SetupParameters {
  std::int64_t axes = 4;
  double axis_spacing_m = 0.12;
  double axis_travel_m = 1.39;
  double axis_velocity_mps = 5.0;
  double axis_acceleration_mps2 = 50.0;
  double frame_period_s = 0.1;
  double look_ahead_m = 1.0;

  void visit(ParameterVisitor& v);
  bool operator==(const SetupParameters&) const = default;
};

/// The axes one behind another along x, about the base frame's origin, the first in front.
[[nodiscard]] std::vector<planning::AxisSpec> axis_specs(const SetupParameters& setup);

}  // namespace furrow::experiments
