#pragma once

#include <string>
#include <vector>

#include "furrow_geometry/tool_model.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::components {

/// An axis of the tool as the planner uses it: by the y of its nozzle in the base frame B.
struct LateralAxis {
  geometry::AxisModel model;

  [[nodiscard]] double nozzle_y_m(double position_m) const;
  /// The axis position that puts the nozzle at y.
  [[nodiscard]] double position_m(double nozzle_y_m) const;
  [[nodiscard]] planning::AxisSpec spec() const;
};

/// All axes of the tool, in its order. Throws ConfigError: an axis does not move along y.
[[nodiscard]] std::vector<LateralAxis> lateral_axes(const geometry::ToolModel& tool);
[[nodiscard]] std::vector<planning::AxisSpec> specs(const std::vector<LateralAxis>& axes);

}  // namespace furrow::components
