#include "axis_conversion.hpp"

#include "furrow_components/conversions.hpp"
#include "furrow_graph/stamp.hpp"

namespace furrow::components {

msgs::DriveState drive_state(actuation::AxisState state) {
  using actuation::AxisState;
  using msgs::DriveState;
  switch (state) {
    case AxisState::kDisabled:
      return DriveState::kDisabled;
    case AxisState::kHoming:
      return DriveState::kHoming;
    case AxisState::kReady:
      return DriveState::kReady;
    case AxisState::kMoving:
      return DriveState::kMoving;
    case AxisState::kFault:
      return DriveState::kFault;
    case AxisState::kEmergencyStop:
      break;
  }
  return DriveState::kEmergencyStop;
}

msgs::AxisMode axis_mode(actuation::ControllerMode mode) {
  using actuation::ControllerMode;
  using msgs::AxisMode;
  switch (mode) {
    case ControllerMode::kWaiting:
      return AxisMode::kWaiting;
    case ControllerMode::kRunning:
      return AxisMode::kRunning;
    case ControllerMode::kInactive:
      return AxisMode::kInactive;
    case ControllerMode::kSafe:
      break;
  }
  return AxisMode::kSafe;
}

msgs::SafetyCause safety_cause(actuation::SafetyCause cause) {
  using From = actuation::SafetyCause;
  using To = msgs::SafetyCause;
  switch (cause) {
    case From::kNone:
      return To::kNone;
    case From::kEmergencyStop:
      return To::kEmergencyStop;
    case From::kPeerLost:
      return To::kPeerLost;
    case From::kPlanStale:
      return To::kPlanStale;
    case From::kOdometryStale:
      return To::kOdometryStale;
    case From::kOdometryInvalid:
      return To::kOdometryInvalid;
    case From::kReadingStale:
      return To::kReadingStale;
    case From::kDriveFault:
      return To::kDriveFault;
    case From::kPositionLimit:
      return To::kPositionLimit;
    case From::kFollowingError:
      return To::kFollowingError;
    case From::kValveFault:
      return To::kValveFault;
    case From::kProtectionOverflow:
      return To::kProtectionOverflow;
    case From::kProtectionInvalid:
      return To::kProtectionInvalid;
    case From::kTracksStale:
      return To::kTracksStale;
    case From::kLoopStalled:
      return To::kLoopStalled;
    case From::kLatchesUnknown:
      break;
  }
  return To::kLatchesUnknown;
}

actuation::SafetyCause safety_cause(msgs::SafetyCause cause) {
  for (const actuation::SafetyRule& rule : actuation::safety_rules()) {
    if (safety_cause(rule.cause) == cause) return rule.cause;
  }
  return actuation::SafetyCause::kNone;
}

msgs::AxisEventKind skip_event(actuation::SkipReason reason) {
  using actuation::SkipReason;
  using msgs::AxisEventKind;
  switch (reason) {
    case SkipReason::kNone:
      return AxisEventKind::kSprayed;
    case SkipReason::kLate:
    case SkipReason::kUnreachable:
      return AxisEventKind::kUnreachable;
    case SkipReason::kStale:
      return AxisEventKind::kStale;
    case SkipReason::kProtectedCrop:
      return AxisEventKind::kProtectedCrop;
    case SkipReason::kInactive:
      return AxisEventKind::kInactive;
    case SkipReason::kFault:
    case SkipReason::kStanding:
      break;
  }
  return AxisEventKind::kFault;
}

actuation::PlannedStop from_msg(const furrow_msgs::msg::Stop& message) {
  actuation::PlannedStop stop;
  stop.stop_id = message.id();
  stop.p_F = from_point(message.aim()).head<2>();
  for (const std::int64_t track : message.track_ids()) stop.targets.push_back(track);
  stop.intended = graph::from_msg(message.expected());
  stop.observed = graph::from_msg(message.observed());
  stop.fire_while_moving = message.while_moving();
  return stop;
}

furrow_msgs::msg::AxisEvent to_msg(const actuation::ControllerEvent& event, const std::string& axis,
                                   msgs::AxisEventKind kind) {
  furrow_msgs::msg::AxisEvent message;
  message.header(header(event.time, kFieldFrame));
  message.axis(axis);
  message.event(msgs::to_msg(kind));
  message.cause(msgs::to_msg(safety_cause(event.cause)));
  message.stop_id(event.stop_id);
  for (std::size_t i = 0; i < event.targets.size(); ++i) {
    message.track_ids().push_back(event.targets[i]);
  }
  message.aim(to_point(event.aim_F));
  return message;
}

}  // namespace furrow::components
