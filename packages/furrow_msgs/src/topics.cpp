#include "furrow_msgs/topics.hpp"

#include <algorithm>
#include <vector>

namespace furrow::msgs {
namespace {

enum Row : std::size_t {
  kClock,
  kCameraImage,
  kCameraDepth,
  kCameraInfo,
  kWheelOdometry,
  kImu,
  kGnssFix,
  kRobotOdometry,
  kTransforms,
  kStaticTransforms,
  kRobotDescription,
  kInstances,
  kTracks,
  kPlan,
  kPlannerHeartbeat,
  kSpeedRequest,
  kAxisState,
  kAxisEvent,
  kJointStates,
  kEmergencyStop,
  kToolReset,
  kToolEnable,
  kMarkers,
  kTrueOdometry,
  kTrueField,
  kTrueInstances,
  kTrueSpray,
  kRunStatus,
  kRunRecord,
  kDiagnostics,
  kRosout
};

// A stream whose gaps and lost writers are counted.
constexpr Qos watched(Qos qos, Duration deadline) {
  qos.deadline = deadline;
  qos.liveliness_lease = Duration::milliseconds(100);
  return qos;
}
constexpr Duration kFastGap = Duration::milliseconds(100);
constexpr Duration kPlanGap = Duration::milliseconds(1000);

// Sensors and pose of the robot.
std::vector<Topic> robot_topics() {
  return {
      {"clock", &message_type<topics::Clock::Message>(), sensor_stream_qos(10), 0, "",
       "Simulated time, as ROS 2 nodes with use_sim_time read it."},
      {"camera/image", &message_type<topics::CameraImage::Message>(), sensor_stream_qos(), 3,
       "camera_optical", "Colour image: bgr8, or another encoding of 8 bits a channel."},
      {"camera/depth", &message_type<topics::CameraDepth::Message>(), sensor_stream_qos(), 3,
       "camera_optical",
       "Depth registered to the colour image: 32FC1 in m, or 16UC1; 0 where unknown."},
      {"camera/camera_info", &message_type<topics::CameraInfo::Message>(), sensor_stream_qos(), 3,
       "camera_optical", "Intrinsics of the camera, in px, and its distortion."},
      {"wheel/odometry", &message_type<topics::WheelOdometry::Message>(), sensor_stream_qos(50), 50,
       "odom", "Speed and yaw rate from the wheels, dead-reckoned pose; m, m/s, rad/s."},
      {"imu/data", &message_type<topics::Imu::Message>(), sensor_stream_qos(100), 100, "base_link",
       "Angular rates and accelerations; rad/s, m/s2."},
      {"gnss/fix", &message_type<topics::GnssFix::Message>(), sensor_stream_qos(10), 5,
       "gnss_antenna", "RTK position of the antenna; degrees, m, covariance in m2."},
      {"localization/odometry", &message_type<topics::RobotOdometry::Message>(),
       watched(reliable_stream_qos(50), kFastGap), 50, "field",
       "Pose X_FB of the base in the field frame, twist in the base frame."},
      {"tf", &message_type<topics::Transforms::Message>(), reliable_stream_qos(50), 50, "field",
       "Moving transforms: field to base_link."},
      {"tf_static", &message_type<topics::StaticTransforms::Message>(), latched_qos(), 0,
       "base_link", "Static transforms: base_link to the cameras' optical frames."},
      {"robot_description", &message_type<topics::RobotDescription::Message>(), latched_qos(), 0,
       "", "The URDF."},
  };
}

// From the plants of an image to the sprays, and the safety of the tool.
std::vector<Topic> weeding_topics() {
  return {
      {"perception/instances", &message_type<topics::Instances::Message>(), reliable_stream_qos(5),
       3, "camera_optical",
       "The plants of one image: class, mask, box, stem (px and m), area (mm2)."},
      {"tracker/tracks", &message_type<topics::Tracks::Message>(), reliable_stream_qos(5), 3,
       "field", "Every plant in view or in memory, refined over its views; m, mm2."},
      {"planner/plan", &message_type<topics::Plan::Message>(),
       watched(reliable_stream_qos(5), kPlanGap), 3, "field",
       "A route per axis and a decision for every track."},
      {"planner/heartbeat", &message_type<topics::PlannerHeartbeat::Message>(),
       watched(reliable_stream_qos(1), kFastGap), 50, "",
       "Liveness signal of the planner; without it the axes enter the safe state."},
      {"robot/speed_request", &message_type<topics::SpeedRequest::Message>(),
       reliable_stream_qos(1), 50, "base_link",
       "The speed at which the tool reaches the weeds ahead, a request to the robot; m/s."},
      {"axis/state", &message_type<topics::AxisState::Message>(),
       watched(reliable_stream_qos(50), kFastGap), 50, "",
       "Position, velocity and state of one axis; m, m/s."},
      {"axis/event", &message_type<topics::AxisEvent::Message>(), event_qos(), 0, "field",
       "A spray, a skipped stop with its reason, or a safe state with its cause."},
      {"joint_states", &message_type<topics::JointStates::Message>(), reliable_stream_qos(50), 50,
       "", "The axes as ROS 2 shows them; m, m/s."},
      {"emergency_stop", &message_type<topics::EmergencyStop::Message>(), latched_qos(), 0, "",
       "Valves shut and axes stopped while active."},
      {"tool/reset", &message_type<topics::ToolReset::Message>(), event_qos(), 0, "",
       "Resets latched causes of the safe state."},
      {"tool/enable", &message_type<topics::ToolEnable::Message>(), latched_qos(), 0, "",
       "Whether the tool is down and may work, or raised."},
      {"markers", &message_type<topics::Markers::Message>(), event_qos(), 3, "field",
       "Plants, plan and sprays as RViz draws them; m."},
  };
}

// Ground truth of a simulation, and the state of the run.
std::vector<Topic> run_topics() {
  return {
      {"truth/odometry", &message_type<topics::TrueOdometry::Message>(), reliable_stream_qos(50),
       50, "field", "Simulation only: the true pose of the base."},
      {"truth/field", &message_type<topics::TrueField::Message>(), latched_qos(), 0, "field",
       "Simulation only: all plants of the field; m, mm2."},
      {"truth/instances", &message_type<topics::TrueInstances::Message>(), reliable_stream_qos(5),
       3, "camera_optical", "Simulation only: the output of a perfect detector."},
      {"truth/spray", &message_type<topics::TrueSpray::Message>(), event_qos(), 0, "field",
       "Simulation only: where a spray landed; m."},
      {"run/status", &message_type<topics::RunStatus::Message>(), reliable_stream_qos(10), 5, "",
       "Progress of the run; the last message says finished."},
      {"run/record", &message_type<topics::RunRecord::Message>(), latched_qos(), 0, "field",
       "The data of the ledger, once at the end."},
      {"diagnostics", &message_type<topics::Diagnostics::Message>(), reliable_stream_qos(50), 1, "",
       "Health of the components: level, message, counters."},
      {"rosout", &message_type<topics::Rosout::Message>(), rosout_qos(), 0, "",
       "The log: time, level, component, message."},
  };
}

// All topics, in the order of Row.
const std::vector<Topic>& table() {
  static const std::vector<Topic> rows = [] {
    std::vector<Topic> all = robot_topics();
    for (const auto& group : {weeding_topics(), run_topics()}) {
      all.insert(all.end(), group.begin(), group.end());
    }
    return all;
  }();
  return rows;
}

}  // namespace

namespace topics {

const Topic& Clock::topic() {
  return table()[kClock];
}
const Topic& CameraImage::topic() {
  return table()[kCameraImage];
}
const Topic& CameraDepth::topic() {
  return table()[kCameraDepth];
}
const Topic& CameraInfo::topic() {
  return table()[kCameraInfo];
}
const Topic& WheelOdometry::topic() {
  return table()[kWheelOdometry];
}
const Topic& Imu::topic() {
  return table()[kImu];
}
const Topic& GnssFix::topic() {
  return table()[kGnssFix];
}
const Topic& RobotOdometry::topic() {
  return table()[kRobotOdometry];
}
const Topic& Transforms::topic() {
  return table()[kTransforms];
}
const Topic& StaticTransforms::topic() {
  return table()[kStaticTransforms];
}
const Topic& RobotDescription::topic() {
  return table()[kRobotDescription];
}
const Topic& Instances::topic() {
  return table()[kInstances];
}
const Topic& Tracks::topic() {
  return table()[kTracks];
}
const Topic& Plan::topic() {
  return table()[kPlan];
}
const Topic& PlannerHeartbeat::topic() {
  return table()[kPlannerHeartbeat];
}
const Topic& SpeedRequest::topic() {
  return table()[kSpeedRequest];
}
const Topic& AxisState::topic() {
  return table()[kAxisState];
}
const Topic& AxisEvent::topic() {
  return table()[kAxisEvent];
}
const Topic& JointStates::topic() {
  return table()[kJointStates];
}
const Topic& EmergencyStop::topic() {
  return table()[kEmergencyStop];
}
const Topic& ToolReset::topic() {
  return table()[kToolReset];
}
const Topic& ToolEnable::topic() {
  return table()[kToolEnable];
}
const Topic& Markers::topic() {
  return table()[kMarkers];
}
const Topic& TrueOdometry::topic() {
  return table()[kTrueOdometry];
}
const Topic& TrueField::topic() {
  return table()[kTrueField];
}
const Topic& TrueInstances::topic() {
  return table()[kTrueInstances];
}
const Topic& TrueSpray::topic() {
  return table()[kTrueSpray];
}
const Topic& RunStatus::topic() {
  return table()[kRunStatus];
}
const Topic& RunRecord::topic() {
  return table()[kRunRecord];
}
const Topic& Diagnostics::topic() {
  return table()[kDiagnostics];
}
const Topic& Rosout::topic() {
  return table()[kRosout];
}

}  // namespace topics

std::span<const Topic> all_topics() {
  return table();
}

const Topic* find_topic(std::string_view name) {
  const auto it = std::ranges::find(table(), name, &Topic::name);
  return it == table().end() ? nullptr : &*it;
}

}  // namespace furrow::msgs
