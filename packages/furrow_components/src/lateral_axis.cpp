#include "lateral_axis.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::components {

double LateralAxis::nozzle_y_m(double position_m) const {
  return model.nozzle_position_B(position_m).y();
}

double LateralAxis::position_m(double nozzle_y_m) const {
  return (nozzle_y_m - model.p_BN0.y()) / model.direction_B.y();
}

planning::AxisSpec LateralAxis::spec() const {
  const auto [lower, upper] = std::minmax({nozzle_y_m(model.lower_m), nozzle_y_m(model.upper_m)});
  return {.offset_x_m = model.p_BN0.x(),
          .lower_m = lower,
          .upper_m = upper,
          .max_velocity_mps = model.max_velocity_mps,
          .max_acceleration_mps2 = model.max_acceleration_mps2};
}

std::vector<LateralAxis> lateral_axes(const geometry::ToolModel& tool) {
  constexpr double kLeastAlongY = 0.99;
  std::vector<LateralAxis> axes;
  for (const geometry::AxisModel& axis : tool.axes) {
    if (std::abs(axis.direction_B.y()) < kLeastAlongY) {
      throw ConfigError("axis '" + axis.name + "' does not move along y: the planner supports " +
                        "lateral axes only");
    }
    axes.push_back({axis});
  }
  return axes;
}

std::vector<planning::AxisSpec> specs(const std::vector<LateralAxis>& axes) {
  std::vector<planning::AxisSpec> list;
  list.reserve(axes.size());
  for (const LateralAxis& axis : axes) list.push_back(axis.spec());
  return list;
}

}  // namespace furrow::components
