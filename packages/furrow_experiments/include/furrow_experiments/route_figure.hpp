#pragma once

#include <string>
#include <vector>

#include "furrow_experiments/drive.hpp"

namespace furrow::experiments {

/// What one planner did on a stretch of a field that others drove too.
struct RouteExample {
  std::string title;
  FieldTargets field;
  DriveResult drive;
  SetupParameters setup;
  double footprint_radius_m = 0.025;
  double from_x_m = 0.0;
  double to_x_m = 0.0;
};

/// The stretch from above as an <svg> element, to scale: travel to the right, y (left of the robot)
/// up. It shows weeds treated and missed, crops, footprints, and each axis's way between sprays.
[[nodiscard]] std::string to_svg(const RouteExample& example);

}  // namespace furrow::experiments
