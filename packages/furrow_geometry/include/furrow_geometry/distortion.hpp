#pragma once

#include <string>
#include <vector>

namespace furrow::geometry {

/// How a lens departs from a pinhole, as sensor_msgs/CameraInfo names it.
struct Distortion {
  std::string model;                 ///< empty: none
  std::vector<double> coefficients;  ///< plumb_bob 5, rational_polynomial 8, equidistant 4

  bool operator==(const Distortion&) const = default;
};

}  // namespace furrow::geometry
