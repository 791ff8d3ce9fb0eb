#pragma once

#include <string>

#include "furrow_core/time.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// What the diagnostics report of an axis besides its state.
struct AxisRemarks {
  std::string refusal;        ///< last refusal of the drive; empty: none
  std::string not_confirmed;  ///< device protections that are not confirmed; empty: none
  std::string latches;        ///< how the latched causes survive a restart
};

/// One axis as ROS 2 diagnostics. Level error: safe state, with its cause and time. Level warning:
/// the axis waits, with the drive's refusal, or a protection of its devices is not confirmed.
[[nodiscard]] diagnostic_msgs::msg::DiagnosticArray axis_diagnostics(
    const std::string& component, const furrow_msgs::msg::AxisState& state, Time cause_found,
    const AxisRemarks& remarks);

}  // namespace furrow::components
