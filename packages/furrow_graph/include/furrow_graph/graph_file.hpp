#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::graph {

/// One component of a graph, as its file names it.
struct ComponentSpec {
  std::string name;
  std::string group;  ///< the name in the file; differs from `name` after for_each
  std::string class_name;
  std::string library;             ///< empty: found by the class name
  std::string for_each;            ///< the list to expand over; empty: none
  std::string for_each_parameter;  ///< gets the list's entry
  std::vector<GivenParameter> parameters;
  std::map<std::string, std::string> remaps;  ///< port -> topic
  bool dedicated_thread = false;              ///< in real time
  int priority = 0;  ///< of the dedicated thread under SCHED_FIFO, 1 to 99; 0: no SCHED_FIFO
  SourceLocation where;
  SourceLocation class_where = {};
  std::map<std::string, SourceLocation> remaps_where = {};  ///< by port
  /// Runs in every process of a deployment and publishes nothing that the graph reads.
  bool everywhere = false;
};

/// The components of a graph and their connections. A deployment says where they run.
///
///   graph: weeding
///   common: {tool_file: ../urdf/bonnbot.urdf}   # for every component that declares the parameter
///   external: [emergency_stop]                   # topics that come from outside the graph
///   components:
///     tracker:
///       class: tracker
///       parameters_file: ../components/tracker.yaml
///       parameters: {confirm_views: 2}           # over those of the file
///       remap: {perception/instances: truth/instances}
///     axis:
///       class: axis_driver
///       thread: dedicated       # in real time: not called by the thread pool
///       priority: 60            # SCHED_FIFO and locked memory, where permitted
///       for_each: axes          # one component "axis_NAME" for each NAME of the list
///       parameter: axis         # which parameter takes NAME
struct GraphSpec {
  std::string name;
  SourceLocation where;
  std::vector<GivenParameter> common;
  std::vector<std::string> external;
  std::vector<ComponentSpec> components;  ///< in the order of the file
};

/// Reads a graph file. `for_each` entries stay until expand_lists(). Throws ConfigError with file,
/// line and key.
[[nodiscard]] GraphSpec load_graph(const std::filesystem::path& path);

/// The value of a common parameter, or empty.
[[nodiscard]] std::string common_text(const GraphSpec& graph, std::string_view name);

/// Replaces each `for_each` entry by one component per name of its list.
void expand_lists(GraphSpec& graph, const std::map<std::string, std::vector<std::string>>& lists);

/// Overrides parameters with "COMPONENT.KEY=VALUE", or "common.KEY=VALUE" for common ones. Throws
/// ConfigError if no component has that name.
void apply_settings(GraphSpec& graph, const std::vector<std::string>& settings);

/// Which component runs in which process on which host.
///
///   deployment: three_hosts
///   hosts: {vision: 192.168.10.1, tool: 192.168.10.2}
///   processes:
///     vision: {host: vision, components: [camera, "perception?"]}   # "?": optional
///     robot: {host: tool, components: [robot], restart: false}
///     others: {host: tool, components: "*", each: true}
///   wire: {domain_id: 7}        # parameters of the transport
struct ProcessSpec {
  std::string name;
  std::string host;
  std::vector<std::string> components;  ///< names or groups; "*": all that no other process names
  bool each = false;                    ///< one process for each component, with its name
  bool restart = true;                  ///< false: the run ends with this process
  SourceLocation where;
};

struct HostSpec {
  std::string name;
  std::string address;
};

struct DeploymentSpec {
  std::string name;
  SourceLocation where;
  std::vector<HostSpec> hosts;  ///< empty: one host
  std::vector<ProcessSpec> processes;
  std::vector<GivenParameter> transport;
};

[[nodiscard]] DeploymentSpec load_deployment(const std::filesystem::path& path);

/// Overrides addresses of the file with "HOST=ADDRESS". Throws ConfigError.
void apply_addresses(DeploymentSpec& deployment, const std::vector<std::string>& addresses);
/// Overrides parameters of the transport with "KEY=VALUE". Throws ConfigError.
void apply_transport_settings(DeploymentSpec& deployment, const std::vector<std::string>& settings);

/// The transport's parameters on a host. If the deployment has hosts, two parameters have defaults:
/// `interfaces` is the host's address. `peers` are all other hosts with the discovery
/// "static_peers", and the first host with "discovery_server".
[[nodiscard]] std::vector<GivenParameter> transport_parameters(const DeploymentSpec& deployment,
                                                               const std::string& host);

/// A process with its components, in the order of the graph.
struct PlacedProcess {
  std::string name;
  std::string host;
  std::vector<std::string> components;
  bool restart = true;
};

/// The processes that have components, in the order of the deployment. Throws ConfigError if a
/// component is in no process or in two, or if a process names an unknown component.
[[nodiscard]] std::vector<PlacedProcess> place_components(const GraphSpec& graph,
                                                          const DeploymentSpec& deployment);

}  // namespace furrow::graph
