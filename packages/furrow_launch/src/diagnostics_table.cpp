#include "furrow_launch/diagnostics_table.hpp"

#include "furrow_launch/run_summary.hpp"

namespace furrow::launch {
namespace {

bool is_of_others(const std::string& name, const diagnostic_msgs::msg::DiagnosticStatus& status,
                  const std::string& own_process) {
  return status.hardware_id() != own_process || name.ends_with(": transport");
}

}  // namespace

ledger::ReportTable diagnostics_table(
    const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics,
    const std::string& own_process) {
  ledger::ReportTable table{"Other processes and the transport",
                            {"process: component", "health", "received", "dropped", "counters"},
                            {}};
  for (const auto& [name, status] : diagnostics) {
    if (!is_of_others(name, status, own_process)) continue;
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
    table.rows.push_back(
        {name, health_text(status.level(), status.message()), received, dropped, counters});
  }
  return table;
}

std::vector<std::string> not_well(
    const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics,
    const std::string& own_process) {
  std::vector<std::string> lines;
  for (const auto& [name, status] : diagnostics) {
    if (status.level() == 0 || !is_of_others(name, status, own_process)) continue;
    lines.push_back(name + ": " + health_text(status.level(), status.message()));
  }
  return lines;
}

}  // namespace furrow::launch
