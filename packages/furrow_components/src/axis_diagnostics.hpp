#pragma once

#include <string>

#include "furrow_core/time.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// What is told of an axis besides its state.
struct AxisRemarks {
  std::string refusal;        ///< of the drive; empty: none
  std::string not_confirmed;  ///< protections of the devices; empty: all are
  std::string latches;        ///< how they are kept over a restart
};

/// One axis as ROS 2's diagnostics show it: an error in the safe state, with the cause and when it
/// was found; a warning while it waits, with what the drive refused, or while a protection of its
/// devices is not confirmed.
[[nodiscard]] diagnostic_msgs::msg::DiagnosticArray axis_diagnostics(
    const std::string& component, const furrow_msgs::msg::AxisState& state, Time cause_found,
    const AxisRemarks& remarks);

}  // namespace furrow::components
