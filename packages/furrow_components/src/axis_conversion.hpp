#pragma once

#include <string>

#include "furrow_actuation/axis_controller_types.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

[[nodiscard]] msgs::DriveState drive_state(actuation::AxisState state);
[[nodiscard]] msgs::AxisMode axis_mode(actuation::ControllerMode mode);
[[nodiscard]] msgs::SafetyCause safety_cause(actuation::SafetyCause cause);
[[nodiscard]] actuation::SafetyCause safety_cause(msgs::SafetyCause cause);
/// The event of a stop that was skipped for `reason`; kNone: it was sprayed.
[[nodiscard]] msgs::AxisEventKind skip_event(actuation::SkipReason reason);

[[nodiscard]] actuation::PlannedStop from_msg(const furrow_msgs::msg::Stop& message);
/// An event of the controller of `axis`, with its time, stop, targets and aim.
[[nodiscard]] furrow_msgs::msg::AxisEvent to_msg(const actuation::ControllerEvent& event,
                                                 const std::string& axis, msgs::AxisEventKind kind);

}  // namespace furrow::components
