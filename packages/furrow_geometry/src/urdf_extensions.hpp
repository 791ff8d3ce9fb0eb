#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_geometry/camera.hpp"

namespace furrow::geometry {

/// <limit> of a prismatic joint, with the rates that urdfdom does not read.
struct LimitElement {
  double lower_m = 0.0;
  double upper_m = 0.0;
  double velocity_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double jerk_mps3 = 0.0;
};

struct NozzleElement {
  int line = 0;
  std::string link;
  double footprint_radius_m = 0.0;
};

struct CameraElement {
  int line = 0;
  std::string link;
  CameraIntrinsics intrinsics;
};

/// A prismatic joint of the file.
struct PrismaticElement {
  int line = 0;
  LimitElement limit;
};

/// The parts of the XML that urdfdom does not read: limits of prismatic joints and the <furrow>
/// element. urdfdom reads the kinematic tree.
struct UrdfExtensions {
  int line = 0;  ///< of <furrow>
  std::string base_link = "base_link";
  std::map<std::string, PrismaticElement> prismatic;  ///< by the joint's name
  std::vector<NozzleElement> nozzles;
  std::vector<CameraElement> cameras;
};

/// Throws ConfigError with `origin`, line and element.
[[nodiscard]] UrdfExtensions read_urdf_extensions(std::string_view urdf, std::string_view origin);

}  // namespace furrow::geometry
