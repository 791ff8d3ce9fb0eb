#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_ledger/run_record.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

inline constexpr char kFieldFrame[] = "field";
inline constexpr char kBaseFrame[] = "base_link";
inline constexpr char kCameraFrame[] = "camera_optical";

/// The state of a Track message that is told for the last time.
inline constexpr std::uint8_t kTrackEnded = 3;

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

[[nodiscard]] furrow_msgs::msg::TrueField to_msg(const field::FieldModel& field, Time stamp);
[[nodiscard]] field::FieldModel from_msg(const furrow_msgs::msg::TrueField& message);

[[nodiscard]] sensor_msgs::msg::CameraInfo to_msg(const geometry::CameraIntrinsics& intrinsics,
                                                  Time stamp);
[[nodiscard]] geometry::CameraIntrinsics from_msg(const sensor_msgs::msg::CameraInfo& message);

/// The record that a ledger is made of. `axes` names the axes by their index.
[[nodiscard]] ledger::RunRecord from_msg(const furrow_msgs::msg::RunRecord& message,
                                         std::span<const std::string> axes);

}  // namespace furrow::components
