#include "diagnostics.hpp"

#include <cstdint>

#include "furrow_graph/stamp.hpp"

namespace furrow::graph {
namespace {

using diagnostic_msgs::msg::DiagnosticStatus;

void add_value(DiagnosticStatus& status, const std::string& key, const std::string& value) {
  auto& entry = status.values().emplace_back();
  entry.key(key);
  entry.value(value);
}

DiagnosticStatus status_of(const std::string& process, const std::string& name,
                           const Health& health) {
  DiagnosticStatus status;
  status.level(static_cast<std::uint8_t>(health.level));
  status.name(process.empty() ? name : process + ": " + name);
  status.message(health.message);
  status.hardware_id(process);
  return status;
}

}  // namespace

diagnostic_msgs::msg::DiagnosticArray make_diagnostics(Time now, const std::string& process,
                                                       std::span<const ComponentStatus> components,
                                                       const Health* transport, bool with_times) {
  diagnostic_msgs::msg::DiagnosticArray array;
  array.header().stamp(to_msg(now));
  for (const ComponentStatus& component : components) {
    DiagnosticStatus status = status_of(process, component.name, component.health);
    std::uint64_t received = 0;
    std::uint64_t dropped = 0;
    for (const InputStatus& input : component.inputs) {
      received += input.received;
      dropped += input.dropped;
    }
    add_value(status, "class", component.class_name);
    add_value(status, "received", std::to_string(received));
    add_value(status, "dropped", std::to_string(dropped));
    add_value(status, "callbacks", std::to_string(component.callbacks));
    if (with_times) {
      add_value(status, "missed_timers", std::to_string(component.missed_timers));
      add_value(status, "busy_s", std::to_string(component.busy_s));
      add_value(status, "longest_call_s", std::to_string(component.longest_call_s));
    }
    for (const auto& [counter, count] : component.health.counters) {
      add_value(status, "count/" + counter, std::to_string(count));
    }
    array.status().push_back(std::move(status));
  }
  if (transport != nullptr) {
    DiagnosticStatus status = status_of(process, "transport", *transport);
    for (const auto& [counter, count] : transport->counters) {
      add_value(status, "count/" + counter, std::to_string(count));
    }
    array.status().push_back(std::move(status));
  }
  return array;
}

}  // namespace furrow::graph
