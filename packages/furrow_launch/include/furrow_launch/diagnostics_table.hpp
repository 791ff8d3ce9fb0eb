#pragma once

#include <map>
#include <string>
#include <vector>

#include "furrow_ledger/ledger.hpp"
#include "furrow_msgs/diagnostic_msgs.h"

namespace furrow::launch {

/// The last reported health of the other processes, and of this one's transport, for the report.
[[nodiscard]] ledger::ReportTable diagnostics_table(
    const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics,
    const std::string& own_process);

/// A line for each of them that is not well: "process: component: error: why".
[[nodiscard]] std::vector<std::string> not_well(
    const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics,
    const std::string& own_process);

}  // namespace furrow::launch
