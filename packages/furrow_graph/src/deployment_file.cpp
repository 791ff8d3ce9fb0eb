#include <algorithm>

#include "furrow_graph/graph_file.hpp"
#include "yaml_source.hpp"

namespace furrow::graph {
namespace {

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
                } else {
                  throw ConfigError(source.where(node), name + "." + key,
                                    "unknown key; known: host, components");
                }
              });
  return process;
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
          deployment.wire = source.parameters(value, key);
        } else if (key == "processes") {
          source.each(
              value, key,
              [&](const std::string& name, const YAML::Node& name_node, const YAML::Node& entry) {
                deployment.processes.push_back(read_process(source, name, name_node, entry));
              });
        } else {
          throw ConfigError(source.where(node), key,
                            "unknown key; known: deployment, processes, wire");
        }
      });
  if (deployment.processes.empty()) {
    throw ConfigError(deployment.where, "processes", "is missing or empty");
  }
  return deployment;
}

std::map<std::string, std::vector<std::string>> place_components(const GraphSpec& graph,
                                                                 const DeploymentSpec& deployment) {
  std::map<std::string, std::string> process_of;
  std::map<std::string, std::vector<std::string>> placed;
  for (const ProcessSpec& process : deployment.processes) {
    auto& mine = placed[process.name];
    for (const std::string& wanted : process.components) {
      bool found = false;
      for (const ComponentSpec& component : graph.components) {
        if (wanted != "*" && wanted != component.name && wanted != component.group) continue;
        found = true;
        const auto [it, first] = process_of.emplace(component.name, process.name);
        if (!first) {
          throw ConfigError(
              process.where, process.name,
              "component '" + component.name + "' is already in process '" + it->second + "'");
        }
        mine.push_back(component.name);
      }
      if (!found) {
        throw ConfigError(process.where, process.name,
                          "the graph has no component '" + wanted + "'");
      }
    }
  }
  for (const ComponentSpec& component : graph.components) {
    if (!process_of.contains(component.name)) {
      throw ConfigError(deployment.where, "processes",
                        "component '" + component.name + "' is in no process");
    }
  }
  return placed;
}

}  // namespace furrow::graph
