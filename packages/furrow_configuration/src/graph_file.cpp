#include "furrow_configuration/graph_file.hpp"

#include <algorithm>

#include "furrow_configuration/parameter_file.hpp"
#include "merge.hpp"
#include "yaml_source.hpp"

namespace furrow::configuration {
namespace {

void check_name(const YamlSource& source, const YAML::Node& node, const std::string& name) {
  const bool plain =
      !name.empty() &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (!plain || name == "common") {
    throw ConfigError(source.where(node), name,
                      "is not a component's name (lower-case letters, digits and _; not 'common')");
  }
}

void read_remaps(const YamlSource& source, const YAML::Node& map, graph::ComponentSpec& spec) {
  source.each(map, "remap",
              [&](const std::string& key, const YAML::Node& node, const YAML::Node& value) {
                spec.remaps[key] = source.text(value, key);
                spec.remaps_where[key] = source.where(node);
              });
}

bool read_thread(const YamlSource& source, const YAML::Node& value, const std::string& name) {
  const std::string text = source.text(value, "thread");
  if (text == "dedicated" || text == "pool") return text == "dedicated";
  throw ConfigError(source.where(value), name + ".thread", "must be dedicated or pool");
}

int read_priority(const YamlSource& source, const YAML::Node& value, const std::string& name) {
  const ParameterValue number = parse_parameter_value(source.text(value, "priority"));
  constexpr std::int64_t kHighest = 99;
  if (const auto* priority = std::get_if<std::int64_t>(&number)) {
    if (*priority >= 0 && *priority <= kHighest) return static_cast<int>(*priority);
  }
  throw ConfigError(source.where(value), name + ".priority", "must be a number from 0 to 99");
}

graph::ComponentSpec read_component(const YamlSource& source, const std::string& name,
                                    const YAML::Node& name_node, const YAML::Node& map) {
  graph::ComponentSpec spec;
  spec.name = name;
  spec.group = name;
  spec.where = source.where(name_node);
  std::vector<GivenParameter> over;
  source.each(
      map, name, [&](const std::string& key, const YAML::Node& node, const YAML::Node& value) {
        if (key == "class") {
          spec.class_name = source.text(value, key);
          spec.class_where = source.where(node);
        } else if (key == "library") {
          spec.library = (source.folder() / source.text(value, key)).lexically_normal().string();
        } else if (key == "parameters_file") {
          spec.parameters = read_parameter_file(source.folder() / source.text(value, key));
        } else if (key == "parameters") {
          over = source.parameters(value, key);
        } else if (key == "remap") {
          read_remaps(source, value, spec);
        } else if (key == "for_each") {
          spec.for_each = source.text(value, key);
        } else if (key == "thread") {
          spec.dedicated_thread = read_thread(source, value, name);
        } else if (key == "priority") {
          spec.priority = read_priority(source, value, name);
        } else if (key == "parameter") {
          spec.for_each_parameter = source.text(value, key);
        } else {
          throw ConfigError(
              source.where(node), name + "." + key,
              "unknown key; known: class, library, parameters_file, parameters, remap, "
              "for_each, parameter, thread, priority");
        }
      });
  if (spec.class_name.empty()) throw ConfigError(spec.where, name + ".class", "is missing");
  if (spec.for_each.empty() != spec.for_each_parameter.empty()) {
    throw ConfigError(spec.where, name,
                      "for_each requires parameter, and parameter requires for_each");
  }
  if (spec.priority > 0 && !spec.dedicated_thread) {
    throw ConfigError(spec.where, name + ".priority", "requires thread: dedicated");
  }
  for (GivenParameter& parameter : over) merge(spec.parameters, std::move(parameter));
  return spec;
}

}  // namespace

graph::GraphSpec load_graph(const std::filesystem::path& path) {
  const YamlSource source(path);
  graph::GraphSpec graph;
  graph.where = {path.string(), 1};
  graph.name = path.stem().string();
  source.each(
      source.root(), "",
      [&](const std::string& key, const YAML::Node& node, const YAML::Node& value) {
        if (key == "graph") {
          graph.name = source.text(value, key);
        } else if (key == "common") {
          graph.common = source.parameters(value, key);
        } else if (key == "external") {
          graph.external = source.texts(value, key);
        } else if (key == "components") {
          source.each(
              value, key,
              [&](const std::string& name, const YAML::Node& name_node, const YAML::Node& map) {
                check_name(source, name_node, name);
                graph.components.push_back(read_component(source, name, name_node, map));
              });
        } else {
          throw ConfigError(source.where(node), key,
                            "unknown key; known: graph, common, external, components");
        }
      });
  if (graph.components.empty()) throw ConfigError(graph.where, "components", "is missing or empty");
  return graph;
}

std::string common_text(const graph::GraphSpec& graph, std::string_view name) {
  const auto it = std::ranges::find(graph.common, name, &GivenParameter::name);
  return it == graph.common.end() ? "" : to_text(it->value);
}

void expand_lists(graph::GraphSpec& graph,
                  const std::map<std::string, std::vector<std::string>>& lists) {
  std::vector<graph::ComponentSpec> expanded;
  for (graph::ComponentSpec& spec : graph.components) {
    if (spec.for_each.empty()) {
      expanded.push_back(std::move(spec));
      continue;
    }
    const auto list = lists.find(spec.for_each);
    if (list == lists.end()) {
      throw ConfigError(spec.where, spec.name + ".for_each",
                        "there is no list '" + spec.for_each + "'");
    }
    for (const std::string& entry : list->second) {
      graph::ComponentSpec& copy = expanded.emplace_back(spec);
      copy.name = spec.name + "_" + entry;
      copy.for_each.clear();
      merge(copy.parameters, {spec.for_each_parameter, entry, spec.where});
    }
  }
  graph.components = std::move(expanded);
}

void apply_settings(graph::GraphSpec& graph, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const SourceLocation where{"--set " + setting, 0};
    const auto equals = setting.find('=');
    const auto dot = setting.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
      throw ConfigError(where, "", "is not COMPONENT.KEY=VALUE");
    }
    const std::string component = setting.substr(0, dot);
    const GivenParameter parameter{setting.substr(dot + 1, equals - dot - 1),
                                   parse_parameter_value(setting.substr(equals + 1)), where};
    bool found = component == "common";
    if (found) merge(graph.common, parameter);
    for (graph::ComponentSpec& spec : graph.components) {
      if (spec.name != component && spec.group != component) continue;
      merge(spec.parameters, parameter);
      found = true;
    }
    if (!found) throw ConfigError(where, component, "the graph has no such component");
  }
}

}  // namespace furrow::configuration
