#pragma once

#include <string>
#include <string_view>

#include "furrow_core/time.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

inline constexpr char kFieldFrame[] = "field";
inline constexpr char kBaseFrame[] = "base_link";
inline constexpr char kCameraFrame[] = "camera_optical";

/// No pose or plant is farther than this from the origin of the field frame, along x or y.
inline constexpr double kMaxField_m = 10'000.0;
/// False also where the position is not finite.
[[nodiscard]] bool in_field(double x_m, double y_m);
/// The message for odometry on `topic` that starts outside of the field frame.
[[nodiscard]] std::string outside_field(std::string_view topic, const geometry::Pose2& X_FB);

[[nodiscard]] std_msgs::msg::Header header(Time stamp, const std::string& frame);

/// The planar pose of the base in the frame of the message's header, and how the base moves.
struct BaseOdometry {
  Time stamp;
  geometry::Pose2 X_FB;
  double speed_mps = 0.0;  ///< along B's x
  double yaw_rate_radps = 0.0;
};
[[nodiscard]] BaseOdometry from_msg(const nav_msgs::msg::Odometry& message);
[[nodiscard]] nav_msgs::msg::Odometry to_msg(const BaseOdometry& odometry,
                                             const std::string& frame);

[[nodiscard]] geometry_msgs::msg::Point to_point(const Eigen::Vector3d& p);
[[nodiscard]] geometry_msgs::msg::Point to_point(const Eigen::Vector2d& p);
[[nodiscard]] Eigen::Vector3d from_point(const geometry_msgs::msg::Point& p);

[[nodiscard]] sensor_msgs::msg::CameraInfo to_msg(const geometry::CameraIntrinsics& intrinsics,
                                                  Time stamp);
[[nodiscard]] geometry::CameraIntrinsics from_msg(const sensor_msgs::msg::CameraInfo& message);

}  // namespace furrow::components
