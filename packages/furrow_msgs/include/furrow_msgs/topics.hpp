#pragma once

#include <span>
#include <string>
#include <string_view>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/qos.hpp"

namespace furrow::msgs {

/// Declaration of a topic.
struct Topic {
  std::string_view name;  ///< as in the graph file; its DDS name has "rt/" before it
  const MessageType* type = nullptr;
  Qos qos;
  double rate_hz = 0.0;  ///< usual rate; 0: on change
  std::string_view frame;
  std::string_view description;  ///< with units
};

/// One struct per topic, for components: its message class, and its row of the table
/// (src/topics.cpp).
namespace topics {

struct Clock {
  using Message = rosgraph_msgs::msg::Clock;
  [[nodiscard]] static const Topic& topic();
};

struct CameraImage {
  using Message = sensor_msgs::msg::Image;
  [[nodiscard]] static const Topic& topic();
};

struct CameraDepth {
  using Message = sensor_msgs::msg::Image;
  [[nodiscard]] static const Topic& topic();
};

struct CameraInfo {
  using Message = sensor_msgs::msg::CameraInfo;
  [[nodiscard]] static const Topic& topic();
};

struct WheelOdometry {
  using Message = nav_msgs::msg::Odometry;
  [[nodiscard]] static const Topic& topic();
};

struct Imu {
  using Message = sensor_msgs::msg::Imu;
  [[nodiscard]] static const Topic& topic();
};

struct GnssFix {
  using Message = sensor_msgs::msg::NavSatFix;
  [[nodiscard]] static const Topic& topic();
};

struct RobotOdometry {
  using Message = nav_msgs::msg::Odometry;
  [[nodiscard]] static const Topic& topic();
};

struct Transforms {
  using Message = tf2_msgs::msg::TFMessage;
  [[nodiscard]] static const Topic& topic();
};

struct StaticTransforms {
  using Message = tf2_msgs::msg::TFMessage;
  [[nodiscard]] static const Topic& topic();
};

struct RobotDescription {
  using Message = std_msgs::msg::String;
  [[nodiscard]] static const Topic& topic();
};

struct Instances {
  using Message = furrow_msgs::msg::PlantInstances;
  [[nodiscard]] static const Topic& topic();
};

struct Tracks {
  using Message = furrow_msgs::msg::Tracks;
  [[nodiscard]] static const Topic& topic();
};

struct Plan {
  using Message = furrow_msgs::msg::Plan;
  [[nodiscard]] static const Topic& topic();
};

struct PlannerHeartbeat {
  using Message = furrow_msgs::msg::Heartbeat;
  [[nodiscard]] static const Topic& topic();
};

struct SpeedRequest {
  using Message = geometry_msgs::msg::TwistStamped;
  [[nodiscard]] static const Topic& topic();
};

struct AxisState {
  using Message = furrow_msgs::msg::AxisState;
  [[nodiscard]] static const Topic& topic();
};

struct AxisEvent {
  using Message = furrow_msgs::msg::AxisEvent;
  [[nodiscard]] static const Topic& topic();
};

struct JointStates {
  using Message = sensor_msgs::msg::JointState;
  [[nodiscard]] static const Topic& topic();
};

struct EmergencyStop {
  using Message = furrow_msgs::msg::EmergencyStop;
  [[nodiscard]] static const Topic& topic();
};

struct ToolReset {
  using Message = furrow_msgs::msg::ToolReset;
  [[nodiscard]] static const Topic& topic();
};

struct ToolEnable {
  using Message = furrow_msgs::msg::ToolEnable;
  [[nodiscard]] static const Topic& topic();
};

struct Markers {
  using Message = visualization_msgs::msg::MarkerArray;
  [[nodiscard]] static const Topic& topic();
};

struct TrueOdometry {
  using Message = nav_msgs::msg::Odometry;
  [[nodiscard]] static const Topic& topic();
};

struct TrueField {
  using Message = furrow_msgs::msg::TrueField;
  [[nodiscard]] static const Topic& topic();
};

struct TrueInstances {
  using Message = furrow_msgs::msg::PlantInstances;
  [[nodiscard]] static const Topic& topic();
};

struct TrueSpray {
  using Message = furrow_msgs::msg::TrueSpray;
  [[nodiscard]] static const Topic& topic();
};

struct RunStatus {
  using Message = furrow_msgs::msg::RunStatus;
  [[nodiscard]] static const Topic& topic();
};

struct RunRecord {
  using Message = furrow_msgs::msg::RunRecord;
  [[nodiscard]] static const Topic& topic();
};

struct Diagnostics {
  using Message = diagnostic_msgs::msg::DiagnosticArray;
  [[nodiscard]] static const Topic& topic();
};

struct Rosout {
  using Message = rcl_interfaces::msg::Log;
  [[nodiscard]] static const Topic& topic();
};

}  // namespace topics

/// The table, in the order of docs/reference/topics.md.
[[nodiscard]] std::span<const Topic> all_topics();
/// The row with this name, or null.
[[nodiscard]] const Topic* find_topic(std::string_view name);
/// docs/reference/topics.md.
[[nodiscard]] std::string topics_markdown();

}  // namespace furrow::msgs
