#pragma once

#include <string>

#include "furrow_core/time.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// One axis as ROS 2's diagnostics show it: an error while it is safe, with the cause and when it
/// was found; a warning while it waits, with what the drive refused, if anything.
[[nodiscard]] diagnostic_msgs::msg::DiagnosticArray axis_diagnostics(
    const std::string& component, const furrow_msgs::msg::AxisState& state, Time cause_found,
    const std::string& refusal);

}  // namespace furrow::components
