#include "axis_diagnostics.hpp"

#include "furrow_core/text.hpp"
#include "furrow_graph/health.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {

diagnostic_msgs::msg::DiagnosticArray axis_diagnostics(const std::string& component,
                                                       const furrow_msgs::msg::AxisState& state,
                                                       Time cause_found,
                                                       const AxisRemarks& remarks) {
  diagnostic_msgs::msg::DiagnosticArray array;
  array.header().stamp(state.header().stamp());
  auto& status = array.status().emplace_back();
  status.name(component + ": " + state.axis());
  status.hardware_id(state.axis());
  const auto set = [&](graph::HealthLevel level, const std::string& message) {
    status.level(static_cast<std::uint8_t>(level));
    status.message(message);
  };
  if (state.cause() != msgs::SafetyCause::kNone) {
    set(graph::HealthLevel::kError,
        msgs::to_string(state.cause()) + " at " + fixed(cause_found.to_seconds(), 3) + " s");
  } else if (state.mode() != msgs::AxisMode::kRunning) {
    set(graph::HealthLevel::kWarn,
        remarks.refusal.empty() ? msgs::to_string(state.mode()) : "drive: " + remarks.refusal);
  } else if (!remarks.not_confirmed.empty()) {
    set(graph::HealthLevel::kWarn, "not confirmed: " + remarks.not_confirmed);
  } else {
    set(graph::HealthLevel::kOk, "running");
  }
  const auto value = [&](const std::string& key, const std::string& text) {
    auto& entry = status.values().emplace_back();
    entry.key(key);
    entry.value(text);
  };
  value("drive", msgs::to_string(state.state()));
  value("mode", msgs::to_string(state.mode()));
  std::string latched;
  for (const auto& cause : state.latched()) {
    latched += (latched.empty() ? "" : ", ") + msgs::to_string(cause);
  }
  value("latched", latched);
  value("latches", remarks.latches);
  value("not_confirmed", remarks.not_confirmed);
  value("position_m", fixed(state.position_m(), 4));
  value("travel_m", fixed(state.travel_m(), 3));
  value("openings", std::to_string(state.openings()));
  value("open_s", fixed(state.open_s(), 3));
  value("volume_ml", fixed(state.volume_ml(), 2));
  return array;
}

}  // namespace furrow::components
