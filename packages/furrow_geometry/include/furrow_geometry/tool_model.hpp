#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_geometry/camera.hpp"

namespace furrow::geometry {

/// A spray nozzle, carried by an axis.
struct NozzleModel {
  std::string link;
  double footprint_radius_m = 0.0;  ///< on the ground, with the nozzle at its height
  double height_m = 0.0;            ///< above the ground plane
};

/// A linear axis with one nozzle. Frames: B is the robot's base (base_link: on the ground, x
/// forward, y left, z up), N the nozzle. With the axis at position q the nozzle stands at
/// p_BN0 + q * direction_B.
struct AxisModel {
  std::string name;  ///< the joint's name
  Eigen::Vector3d p_BN0 = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_B = Eigen::Vector3d::UnitY();
  double lower_m = 0.0;
  double upper_m = 0.0;
  double max_velocity_mps = 0.0;
  double max_acceleration_mps2 = 0.0;
  double max_jerk_mps3 = 0.0;
  NozzleModel nozzle;

  [[nodiscard]] Eigen::Vector3d nozzle_position_B(double q_m) const {
    return p_BN0 + q_m * direction_B;
  }
};

/// A camera: intrinsics, and the pose of its optical frame C in the base frame B.
struct CameraModel {
  std::string link;
  CameraIntrinsics intrinsics;
  Eigen::Isometry3d X_BC = Eigen::Isometry3d::Identity();
};

/// The machine, as its URDF describes it. Axes are sorted from the front (largest x first), then by
/// name.
struct ToolModel {
  std::string robot;
  std::string base_link;
  std::vector<AxisModel> axes;
  std::vector<CameraModel> cameras;
};

/// Reads a URDF with Furrow's extension elements (docs/reference/urdf.md). Throws ConfigError
/// with the file and the link or joint: not a URDF, no base link, no axis. Also for an axis without
/// limit or nozzle, a limit that is not positive, and a camera without a size.
[[nodiscard]] ToolModel load_tool_model(const std::filesystem::path& path);
/// The same from text; errors name `origin` as the file.
[[nodiscard]] ToolModel parse_tool_model(std::string_view urdf, std::string_view origin);

}  // namespace furrow::geometry
