#include "furrow_launch/transport_health.hpp"

namespace furrow::launch {

graph::Health TransportHealth::look() {
  graph::Health health;
  std::uint64_t misses = 0;
  std::string incompatible;
  const auto count = [&](const std::string& what, const std::string& topic, std::uint64_t by) {
    if (by == 0) return;
    misses += by;
    health.counters[what + "/" + topic] += static_cast<std::int64_t>(by);
  };
  const std::vector<dds::EndpointStatus> endpoints = transport_.status();
  for (const dds::EndpointStatus& endpoint : endpoints) {
    count("deadline_missed", endpoint.topic, endpoint.deadlines_missed);
    count("writer_lost", endpoint.topic, endpoint.liveliness_losses);
    count("qos_incompatible", endpoint.topic, endpoint.incompatible);
    if (endpoint.incompatible > 0) {
      incompatible += "; " + endpoint.topic + ": " + endpoint.incompatibility;
    }
    count(endpoint.writer ? "not_sent" : "not_received", endpoint.topic, endpoint.counters.dropped);
  }
  if (misses > misses_) {
    health.level = graph::HealthLevel::kWarn;
    for (const auto& [name, total] : health.counters) {
      health.message += (health.message.empty() ? "" : ", ") + name + " " + std::to_string(total);
    }
    health.message += incompatible;
  }
  for (const dds::EndpointStatus& endpoint : endpoints) {
    if (endpoint.best_effort_writers == 0) continue;
    health.counters["best_effort_writers/" + endpoint.topic] += endpoint.best_effort_writers;
  }
  misses_ = misses;
  const graph::Health heard = inputs_.look(endpoints, transport_.discovery());
  if (heard.level != graph::HealthLevel::kOk) {
    health.level = heard.level;
    health.message += (health.message.empty() ? "" : "; ") + heard.message;
  }
  health.counters.insert(heard.counters.begin(), heard.counters.end());
  return health;
}

}  // namespace furrow::launch
