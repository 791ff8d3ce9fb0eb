#pragma once

#include "furrow_core/time.hpp"

namespace furrow::components {

struct AxisPoint {
  Time time;
  double position_m = 0.0;
  double velocity_mps = 0.0;
};

/// The axis at a time, from two measurements. Between them it follows the cubic through both
/// positions and velocities, outside of them a straight line. @pre first.time <= second.time.
[[nodiscard]] AxisPoint axis_at(const AxisPoint& first, const AxisPoint& second, Time time);

}  // namespace furrow::components
