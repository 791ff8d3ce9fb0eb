#include "furrow_actuation/axis_driver.hpp"

namespace furrow::actuation {

std::string_view to_string(AxisState state) {
  switch (state) {
    case AxisState::kDisabled:
      return "disabled";
    case AxisState::kHoming:
      return "homing";
    case AxisState::kReady:
      return "ready";
    case AxisState::kMoving:
      return "moving";
    case AxisState::kFault:
      return "fault";
    case AxisState::kEmergencyStop:
      return "emergency_stop";
  }
  return "unknown";
}

std::string_view to_string(DriveFault fault) {
  switch (fault) {
    case DriveFault::kNone:
      return "none";
    case DriveFault::kFollowingError:
      return "following_error";
    case DriveFault::kPositionLimit:
      return "position_limit";
    case DriveFault::kHomingFailed:
      return "homing_failed";
    case DriveFault::kConnectionLost:
      return "connection_lost";
    case DriveFault::kDrive:
      return "drive";
  }
  return "unknown";
}

}  // namespace furrow::actuation
