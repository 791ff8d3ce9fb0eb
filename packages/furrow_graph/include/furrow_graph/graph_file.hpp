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
  std::string group;  ///< the name in the file; differs from `name` where for_each made several
  std::string class_name;
  std::string library;             ///< empty: found by the class's name
  std::string for_each;            ///< the list to expand over; empty: none
  std::string for_each_parameter;  ///< takes the list's entry
  std::vector<GivenParameter> parameters;
  std::map<std::string, std::string> remaps;  ///< port -> topic
  bool dedicated_thread = false;              ///< in real time
  int priority = 0;  ///< of the dedicated thread under SCHED_FIFO, 1 to 99; 0: as any other thread
  SourceLocation where;
  SourceLocation class_where = {};
  std::map<std::string, SourceLocation> remaps_where = {};  ///< by port
  /// Lives in every process of a deployment, for the process's own purposes; publishes to nobody
  /// in the graph.
  bool everywhere = false;
};

/// The components and their wiring, named once; where they run is said by a deployment.
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
///       thread: dedicated       # in real time: a thread of its own, not one of the pool
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

/// Reads a graph file; `for_each` entries stay as they are until expand_lists(). Throws ConfigError
/// with file, line and key.
[[nodiscard]] GraphSpec load_graph(const std::filesystem::path& path);

/// The value of a common parameter, or empty.
[[nodiscard]] std::string common_text(const GraphSpec& graph, std::string_view name);

/// Replaces each `for_each` entry by one component per name of its list.
void expand_lists(GraphSpec& graph, const std::map<std::string, std::vector<std::string>>& lists);

/// Puts "COMPONENT.KEY=VALUE" over what the file says; "common.KEY=VALUE" for the common ones.
/// Throws ConfigError when no component has that name.
void apply_settings(GraphSpec& graph, const std::vector<std::string>& settings);

/// Which component lives in which process on which host.
///
///   deployment: three_hosts
///   hosts: {vision: 192.168.10.1, tool: 192.168.10.2}
///   processes:
///     vision: {host: vision, components: [camera, "perception?"]}   # "?": if the graph has it
///     robot: {host: tool, components: [robot], restart: false}
///     others: {host: tool, components: "*", each: true}
///   wire: {domain_id: 7}        # parameters of the transport
struct ProcessSpec {
  std::string name;
  std::string host;
  std::vector<std::string> components;  ///< names or groups; "*": all that no other process names
  bool each = false;                    ///< a process for each of the components, named as it
  bool restart = true;                  ///< false: the run cannot go on without it
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

/// Puts "HOST=ADDRESS" over the addresses of the file. Throws ConfigError.
void apply_addresses(DeploymentSpec& deployment, const std::vector<std::string>& addresses);
/// Puts "KEY=VALUE" over the parameters of the transport. Throws ConfigError.
void apply_transport_settings(DeploymentSpec& deployment, const std::vector<std::string>& settings);

/// The transport's parameters on a host. Where the deployment has hosts, what is not given follows
/// from their addresses: `interfaces` is the host's own; `peers` are all others with the discovery
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

/// The processes that have something to run, in the order of the deployment. Throws ConfigError
/// when a component is in no process or in two, or a process names one that the graph does not
/// have.
[[nodiscard]] std::vector<PlacedProcess> place_components(const GraphSpec& graph,
                                                          const DeploymentSpec& deployment);

}  // namespace furrow::graph
