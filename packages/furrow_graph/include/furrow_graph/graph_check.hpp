#pragma once

#include <string>
#include <vector>

#include "furrow_graph/graph_file.hpp"
#include "furrow_graph/registry.hpp"

namespace furrow::graph {

/// Who publishes and who reads a topic, by the names of the components.
struct Connection {
  std::string topic;
  const msgs::MessageType* type = nullptr;
  msgs::Qos qos;
  std::vector<std::string> publishers;
  std::vector<std::string> readers;
};

/// Checks a whole expanded graph, whatever process its components live in: unknown class, unknown
/// or out-of-range parameter, a remap of a port that is not there, a required input that nobody
/// publishes, a type or QoS mismatch. Throws ConfigError with file, line and key. Returns the
/// wiring, sorted by topic.
std::vector<Connection> check_graph(const GraphSpec& graph, Registry& registry);

/// The parameters that a component gets: its own, and those common ones that its class declares.
[[nodiscard]] std::vector<GivenParameter> parameters_of(const ComponentSpec& component,
                                                        const GraphSpec& graph,
                                                        const Description& description);

/// The topic that a port is wired to.
[[nodiscard]] std::string resolved_topic(const ComponentSpec& component, const msgs::Topic& port);

}  // namespace furrow::graph
