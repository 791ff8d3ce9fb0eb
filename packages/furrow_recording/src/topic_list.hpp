#pragma once

#include "furrow_msgs/topics.hpp"

namespace furrow::recording {

/// Calls a generic function once for each topic: `list.for_each([]<class T>() { ... })`.
template <class... Topics>
struct TopicList {
  template <class Function>
  static void for_each(Function function) {
    (function.template operator()<Topics>(), ...);
  }
};

/// What sensors, and in simulation the world, tell; all else follows from it.
using PlayedTopics =
    TopicList<msgs::topics::CameraImage, msgs::topics::CameraDepth, msgs::topics::CameraInfo,
              msgs::topics::WheelOdometry, msgs::topics::Imu, msgs::topics::GnssFix,
              msgs::topics::TrueOdometry, msgs::topics::TrueField, msgs::topics::TrueInstances,
              msgs::topics::RunStatus>;

/// The table of furrow_msgs, row by row.
using AllTopics =
    TopicList<msgs::topics::Clock, msgs::topics::CameraImage, msgs::topics::CameraDepth,
              msgs::topics::CameraInfo, msgs::topics::WheelOdometry, msgs::topics::Imu,
              msgs::topics::GnssFix, msgs::topics::RobotOdometry, msgs::topics::Transforms,
              msgs::topics::StaticTransforms, msgs::topics::RobotDescription,
              msgs::topics::Instances, msgs::topics::Tracks, msgs::topics::Plan,
              msgs::topics::PlannerHeartbeat, msgs::topics::SpeedRequest, msgs::topics::AxisState,
              msgs::topics::AxisEvent, msgs::topics::JointStates, msgs::topics::EmergencyStop,
              msgs::topics::ToolReset, msgs::topics::ToolEnable, msgs::topics::Markers,
              msgs::topics::TrueOdometry, msgs::topics::TrueField, msgs::topics::TrueInstances,
              msgs::topics::TrueSpray, msgs::topics::RunStatus, msgs::topics::RunRecord,
              msgs::topics::Diagnostics, msgs::topics::Rosout>;

}  // namespace furrow::recording
