#include "diagnostics_table.hpp"

#include <array>

namespace furrow::cli {

ledger::ReportTable diagnostics_table(
    const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics,
    const std::string& own_process) {
  constexpr std::array<const char*, 4> kLevels = {"ok", "warning", "error", "stale"};
  ledger::ReportTable table{"Other processes and the wire",
                            {"process: component", "health", "received", "dropped", "counters"},
                            {}};
  for (const auto& [name, status] : diagnostics) {
    if (status.hardware_id() == own_process && !name.ends_with(": wire")) continue;
    std::string health = status.level() < kLevels.size() ? kLevels[status.level()] : "unknown";
    if (!status.message().empty()) health += ": " + status.message();
    std::string received = "-";
    std::string dropped = "-";
    std::string counters;
    constexpr std::string_view kCounter = "count/";
    for (const auto& value : status.values()) {
      if (value.key() == "received") received = value.value();
      if (value.key() == "dropped") dropped = value.value();
      if (!value.key().starts_with(kCounter)) continue;
      counters += (counters.empty() ? "" : ", ") + value.key().substr(kCounter.size()) + " " +
                  value.value();
    }
    table.rows.push_back({name, health, received, dropped, counters});
  }
  return table;
}

}  // namespace furrow::cli
