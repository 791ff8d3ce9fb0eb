#pragma once

#include <map>
#include <string>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_dds/discovery.hpp"
#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/health.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/qos.hpp"

namespace furrow::launch {

/// A topic that components of a graph read and none publishes: a driver of the robot has to.
struct ExternalInput {
  std::string topic;
  std::string port;                  ///< of its first reader: the topic's name before remaps
  std::string type;                  ///< name in DDS
  std::string ros_type;              ///< "sensor_msgs/msg/Image"
  msgs::Qos qos;                     ///< as its first reader requests it
  bool required = false;             ///< at least one reader does not work without it
  std::vector<std::string> readers;  ///< components
};

/// The inputs that a graph expects from other processes, by topic. These are the required ones, and
/// of the graph's `external` topics those that are sent at a rate. An operator's commands, such as
/// emergency_stop, may stay silent.
[[nodiscard]] std::vector<ExternalInput> external_inputs(const graph::GraphSpec& graph,
                                                         graph::Registry& registry);

/// Tells which external inputs have not been heard, and why. Not thread-safe.
class InputWatch {
 public:
  explicit InputWatch(std::vector<ExternalInput> inputs) : inputs_(std::move(inputs)) {}

  /// To be called once a second, with the endpoints of the own process and the domain as it is now.
  /// A warning where the findings changed, and every ten calls while an input is missing. The first
  /// two calls are silent: discovery takes a moment.
  [[nodiscard]] graph::Health look(const std::vector<dds::EndpointStatus>& endpoints,
                                   const dds::DiscoverySnapshot& domain);

 private:
  std::vector<ExternalInput> inputs_;
  std::string last_;
  int calls_ = 0;
};

}  // namespace furrow::launch
