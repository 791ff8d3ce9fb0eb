#include "furrow_configuration/deployment_file.hpp"

#include <algorithm>
#include <set>

#include "furrow_configuration/parameter_file.hpp"
#include "merge.hpp"
#include "yaml_source.hpp"

namespace furrow::configuration {
namespace {

bool flag(const YamlSource& source, const YAML::Node& node, const std::string& key) {
  const ParameterValue value = YamlSource::value(node);
  if (const bool* yes = std::get_if<bool>(&value)) return *yes;
  throw ConfigError(source.where(node), key, "must be true or false");
}

ProcessSpec read_process(const YamlSource& source, const std::string& name,
                         const YAML::Node& name_node, const YAML::Node& value) {
  ProcessSpec process;
  process.name = name;
  process.where = source.where(name_node);
  if (!value.IsMap()) {
    process.components = source.texts(value, name);
    return process;
  }
  source.each(value, name,
              [&](const std::string& key, const YAML::Node& node, const YAML::Node& entry) {
                if (key == "host") {
                  process.host = source.text(entry, key);
                } else if (key == "components") {
                  process.components = source.texts(entry, key);
                } else if (key == "each") {
                  process.each = flag(source, entry, name + "." + key);
                } else if (key == "restart") {
                  process.restart = flag(source, entry, name + "." + key);
                } else {
                  throw ConfigError(source.where(node), name + "." + key,
                                    "unknown key; known: host, components, each, restart");
                }
              });
  return process;
}

void check_hosts(const DeploymentSpec& deployment) {
  if (deployment.hosts.empty()) return;
  for (const ProcessSpec& process : deployment.processes) {
    if (std::ranges::find(deployment.hosts, process.host, &HostSpec::name) ==
        deployment.hosts.end()) {
      throw ConfigError(process.where, process.name + ".host",
                        "'" + process.host + "' is not one of the hosts");
    }
  }
}

}  // namespace

DeploymentSpec load_deployment(const std::filesystem::path& path) {
  const YamlSource source(path);
  DeploymentSpec deployment;
  deployment.name = path.stem().string();
  deployment.where = {path.string(), 1};
  source.each(
      source.root(), "",
      [&](const std::string& key, const YAML::Node& node, const YAML::Node& value) {
        if (key == "deployment") {
          deployment.name = source.text(value, key);
        } else if (key == "wire") {
          deployment.transport = source.parameters(value, key);
        } else if (key == "hosts") {
          source.each(value, key,
                      [&](const std::string& name, const YAML::Node&, const YAML::Node& address) {
                        deployment.hosts.push_back({name, source.text(address, name)});
                      });
        } else if (key == "processes") {
          source.each(
              value, key,
              [&](const std::string& name, const YAML::Node& name_node, const YAML::Node& entry) {
                deployment.processes.push_back(read_process(source, name, name_node, entry));
              });
        } else {
          throw ConfigError(source.where(node), key,
                            "unknown key; known: deployment, hosts, processes, wire");
        }
      });
  if (deployment.processes.empty()) {
    throw ConfigError(deployment.where, "processes", "is missing or empty");
  }
  check_hosts(deployment);
  return deployment;
}

void apply_addresses(DeploymentSpec& deployment, const std::vector<std::string>& addresses) {
  for (const std::string& text : addresses) {
    const auto equals = text.find('=');
    const auto host = std::ranges::find(deployment.hosts, text.substr(0, equals), &HostSpec::name);
    if (equals == std::string::npos || host == deployment.hosts.end()) {
      throw ConfigError({"--address " + text, 0}, "",
                        "is not HOST=ADDRESS with a host of the deployment");
    }
    host->address = text.substr(equals + 1);
  }
}

void apply_transport_settings(DeploymentSpec& deployment,
                              const std::vector<std::string>& settings) {
  for (const std::string& text : settings) {
    const auto equals = text.find('=');
    const SourceLocation where{"--wire " + text, 0};
    if (equals == std::string::npos) throw ConfigError(where, "", "is not KEY=VALUE");
    merge(deployment.transport,
          {text.substr(0, equals), parse_parameter_value(text.substr(equals + 1)), where});
  }
}

std::vector<GivenParameter> transport_parameters(const DeploymentSpec& deployment,
                                                 const std::string& host) {
  std::vector<GivenParameter> parameters = deployment.transport;
  const auto own = std::ranges::find(deployment.hosts, host, &HostSpec::name);
  if (own == deployment.hosts.end()) return parameters;
  const auto given = [&](const char* name) {
    return std::ranges::find(deployment.transport, name, &GivenParameter::name);
  };
  if (given("interfaces") == deployment.transport.end()) {
    parameters.push_back({"interfaces", std::vector<std::string>{own->address}, deployment.where});
  }
  const auto discovery = given("discovery");
  if (discovery == deployment.transport.end() || given("peers") != deployment.transport.end())
    return parameters;
  std::vector<std::string> peers;
  if (discovery->value == ParameterValue(std::string("static_peers"))) {
    for (const HostSpec& other : deployment.hosts) {
      if (other.name != host) peers.push_back(other.address);
    }
  } else if (discovery->value == ParameterValue(std::string("discovery_server"))) {
    peers.push_back(deployment.hosts.front().address);
  }
  if (!peers.empty()) parameters.push_back({"peers", std::move(peers), deployment.where});
  return parameters;
}

namespace {

/// Assigns each component to a process.
class Placement {
 public:
  explicit Placement(const graph::GraphSpec& graph) : graph_(graph) {}

  /// Assigns the components that `wanted` names to `process`.
  void take(const ProcessSpec& process, const std::string& wanted) {
    if (wanted == "*") return;
    const bool optional = wanted.ends_with('?');
    const std::string name = optional ? wanted.substr(0, wanted.size() - 1) : wanted;
    bool found = optional;
    for (const graph::ComponentSpec& component : graph_.components) {
      if (name != component.name && name != component.group) continue;
      found = true;
      const auto [it, first] = process_of_.emplace(component.name, &process);
      if (!first) {
        throw ConfigError(
            process.where, process.name,
            "component '" + component.name + "' is already in process '" + it->second->name + "'");
      }
    }
    if (!found) {
      throw ConfigError(process.where, process.name, "the graph has no component '" + name + "'");
    }
  }

  void take_rest(const ProcessSpec& process) {
    for (const graph::ComponentSpec& component : graph_.components) {
      process_of_.emplace(component.name, &process);
    }
  }

  [[nodiscard]] std::vector<std::string> components_of(const ProcessSpec& process) const {
    std::vector<std::string> names;
    for (const graph::ComponentSpec& component : graph_.components) {
      const auto it = process_of_.find(component.name);
      if (it != process_of_.end() && it->second == &process) names.push_back(component.name);
    }
    return names;
  }

  void check_complete(const DeploymentSpec& deployment) const {
    for (const graph::ComponentSpec& component : graph_.components) {
      if (!process_of_.contains(component.name)) {
        throw ConfigError(deployment.where, "processes",
                          "component '" + component.name + "' is in no process");
      }
    }
  }

 private:
  const graph::GraphSpec& graph_;
  std::map<std::string, const ProcessSpec*> process_of_;
};

void check_names(const DeploymentSpec& deployment,
                 const std::vector<graph::PlacedProcess>& placed) {
  std::set<std::string> names;
  for (const graph::PlacedProcess& process : placed) {
    if (!names.insert(process.name).second) {
      throw ConfigError(deployment.where, "processes",
                        "process '" + process.name + "' is given twice");
    }
  }
}

}  // namespace

std::vector<graph::PlacedProcess> place_components(const graph::GraphSpec& graph,
                                                   const DeploymentSpec& deployment) {
  Placement placement(graph);
  for (const ProcessSpec& process : deployment.processes) {
    for (const std::string& wanted : process.components) placement.take(process, wanted);
  }
  for (const ProcessSpec& process : deployment.processes) {
    if (std::ranges::find(process.components, "*") != process.components.end()) {
      placement.take_rest(process);
    }
  }
  placement.check_complete(deployment);
  std::vector<graph::PlacedProcess> placed;
  for (const ProcessSpec& process : deployment.processes) {
    std::vector<std::string> names = placement.components_of(process);
    if (process.each) {
      for (const std::string& name : names) {
        placed.push_back({name, process.host, {name}, process.restart});
      }
    } else if (!names.empty()) {
      placed.push_back({process.name, process.host, std::move(names), process.restart});
    }
  }
  check_names(deployment, placed);
  return placed;
}

}  // namespace furrow::configuration
