#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "furrow_graph/runtime.hpp"
#include "furrow_ledger/ledger.hpp"

namespace furrow::launch {

/// "ok", or "error: why"; levels are those of diagnostic_msgs/DiagnosticStatus.
[[nodiscard]] std::string health_text(std::uint8_t level, const std::string& message);

/// A line for each component that is not well: "driver_axis_1: error: why".
[[nodiscard]] std::vector<std::string> not_well(std::span<const graph::ComponentStatus> components);

/// What the components did, for the report. Wall-clock figures are left out in lock-step, so that
/// two runs of one seed give the same report.
[[nodiscard]] std::vector<ledger::ReportTable> health_tables(
    std::span<const graph::ComponentStatus> components, bool with_times);

/// The short table that a run ends with. `dropped` messages are told of when there are any.
[[nodiscard]] std::string outcome_text(const ledger::Summary& summary, std::uint64_t dropped);

/// Messages that full mailboxes dropped, over all components.
[[nodiscard]] std::uint64_t dropped_messages(std::span<const graph::ComponentStatus> components);

}  // namespace furrow::launch
