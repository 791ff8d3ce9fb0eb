#pragma once

#include <span>
#include <string>

#include "furrow_core/time.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/diagnostic_msgs.h"

namespace furrow::graph {

/// The health of a process as ROS 2 tools show it: a status "PROCESS: COMPONENT" for each
/// component, and "PROCESS: transport" (null: none). Without `with_times` it has no wall-clock
/// times, so that simulated time gives the same bytes.
[[nodiscard]] diagnostic_msgs::msg::DiagnosticArray make_diagnostics(
    Time now, const std::string& process, std::span<const ComponentStatus> components,
    const Health* transport, bool with_times);

}  // namespace furrow::graph
