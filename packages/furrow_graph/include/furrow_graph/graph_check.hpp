#pragma once

#include <string>
#include <vector>

#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/registry.hpp"

namespace furrow::graph {

/// The components that publish and read a topic, by name.
struct Connection {
  std::string topic;
  const msgs::MessageType* type = nullptr;
  msgs::Qos qos;
  std::vector<std::string> publishers;
  std::vector<std::string> readers;
};

/// Checks a whole expanded graph, in every process: unknown classes, parameters and ports,
/// parameters out of range, required inputs without a publisher, types and QoS that do not match.
/// Throws ConfigError with file, line and key. Returns the connections, sorted by topic.
std::vector<Connection> check_graph(const GraphSpec& graph, Registry& registry);

/// The parameters of a component: its own, and the common ones that its class declares.
[[nodiscard]] std::vector<GivenParameter> parameters_of(const ComponentSpec& component,
                                                        const GraphSpec& graph,
                                                        const Description& description);

/// The topic that a port is connected to.
[[nodiscard]] std::string resolved_topic(const ComponentSpec& component, const msgs::Topic& port);

}  // namespace furrow::graph
