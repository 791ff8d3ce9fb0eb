#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "furrow_graph/graph_spec.hpp"

namespace furrow::configuration {

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

/// The processes that have components, in the order of the deployment. Throws ConfigError if a
/// component is in no process or in two, or if a process names an unknown component.
[[nodiscard]] std::vector<graph::PlacedProcess> place_components(const graph::GraphSpec& graph,
                                                                 const DeploymentSpec& deployment);

}  // namespace furrow::configuration
