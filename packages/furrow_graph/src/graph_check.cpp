#include "furrow_graph/graph_check.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace furrow::graph {
namespace {

bool declares(const Description& description, const std::string& parameter) {
  return std::ranges::any_of(
      description.declared_parameters_list(),
      [&](const DeclaredParameter& declared) { return declared.info.name == parameter; });
}

void check_component_parameters(const ComponentSpec& component, const GraphSpec& graph,
                                const Description& description) {
  try {
    check_parameters(description.declared_parameters_list(),
                     parameters_of(component, graph, description));
  } catch (const ConfigError& error) {
    throw ConfigError(std::string(error.what()) + " (component '" + component.name + "', class '" +
                      component.class_name + "')");
  }
}

bool same_value(const ParameterValue& a, const ParameterValue& b) {
  const auto number = [](const ParameterValue& value) -> std::optional<double> {
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      return static_cast<double>(*integer);
    }
    if (const auto* real = std::get_if<double>(&value)) return *real;
    return std::nullopt;
  };
  return number(a) && number(b) ? *number(a) == *number(b) : a == b;
}

/// Holds the values of shared parameters against each other.
class SharedParameters {
 public:
  void add(const ComponentSpec& component, const GraphSpec& graph, const Description& description) {
    const auto given = parameters_of(component, graph, description);
    for (const DeclaredParameter& declared : description.declared_parameters_list()) {
      const auto& shared = description.shared_parameter_names();
      if (std::ranges::find(shared, declared.info.name) == shared.end()) continue;
      const auto own = std::ranges::find(given, declared.info.name, &GivenParameter::name);
      const bool set = own != given.end();
      const Use use{component.name, set ? own->value : declared.default_value,
                    set ? own->where : component.where, set};
      const auto [other, first] = uses_.try_emplace(declared.info.name, use);
      if (!first && !same_value(other->second.value, use.value)) {
        contradict(declared.info.name, other->second, use);
      }
    }
  }

 private:
  struct Use {
    std::string component;
    ParameterValue value;
    SourceLocation where;
    bool set = false;  ///< else the default
  };

  [[noreturn]] static void contradict(const std::string& name, const Use& a, const Use& b) {
    // The error points at a value that is set.
    const Use& at = b.set ? b : a;
    const Use& other = b.set ? a : b;
    throw ConfigError(at.where, at.component + "." + name,
                      to_text(at.value) + " contradicts " + other.component + "." + name +
                          ", which is " + to_text(other.value) + (other.set ? "" : " by default") +
                          "; set common." + name + " instead");
  }

  std::map<std::string, Use> uses_;
};

void check_remaps(const ComponentSpec& component, const Description& description) {
  for (const auto& [port, topic] : component.remaps) {
    const auto has = [&port = port](const std::vector<PortInfo>& ports) {
      return std::ranges::any_of(ports, [&](const PortInfo& p) { return p.topic->name == port; });
    };
    if (!has(description.inputs()) && !has(description.outputs())) {
      const auto where = component.remaps_where.find(port);
      throw ConfigError(where == component.remaps_where.end() ? component.where : where->second,
                        component.name + ".remap." + port,
                        "class '" + component.class_name + "' has no such port");
    }
  }
}

class Wiring {
 public:
  void add(const ComponentSpec& component, const PortInfo& port, bool publishes) {
    const std::string name = resolved_topic(component, *port.topic);
    auto [it, first] = connections_.try_emplace(name);
    Connection& connection = it->second;
    if (first) {
      connection.topic = name;
      connection.type = port.topic->type;
      connection.qos = port.topic->qos;
    }
    if (connection.type != port.topic->type) {
      throw ConfigError(component.where, component.name,
                        "topic '" + name + "' carries " + std::string(connection.type->ros_name) +
                            ", but port '" + std::string(port.topic->name) + "' has type " +
                            std::string(port.topic->type->ros_name));
    }
    if (publishes) {
      check_offer(component, name, port.topic->qos);
      offers_[name].push_back(port.topic->qos);
      connection.publishers.push_back(component.name);
    } else {
      requests_[name].push_back({&component, port});
      connection.readers.push_back(component.name);
    }
  }

  void check(const GraphSpec& graph) const {
    const std::set<std::string> external(graph.external.begin(), graph.external.end());
    for (const auto& [name, requests] : requests_) {
      for (const auto& [component, port] : requests) {
        if (port.need == Need::kRequired && connections_.at(name).publishers.empty() &&
            !external.contains(name)) {
          throw ConfigError(component->where, component->name,
                            "input '" + std::string(port.topic->name) +
                                "' is not connected: no component publishes '" + name + "'");
        }
        check_request(*component, name, port.topic->qos);
      }
    }
  }

  [[nodiscard]] std::vector<Connection> connections() const {
    std::vector<Connection> list;
    for (const auto& [name, connection] : connections_) list.push_back(connection);
    return list;
  }

 private:
  /// Of reliability and durability. Inside a process nothing watches deadlines and leases.
  static std::string incompatibility(const msgs::Qos& offered, msgs::Qos requested) {
    requested.deadline = requested.liveliness_lease = Duration();
    return msgs::incompatibility(offered, requested);
  }

  void check_offer(const ComponentSpec& component, const std::string& name,
                   const msgs::Qos& qos) const {
    const auto it = offers_.find(name);
    if (it == offers_.end()) return;
    const msgs::Qos& first = it->second.front();
    if (!incompatibility(first, qos).empty() || !incompatibility(qos, first).empty()) {
      throw ConfigError(component.where, component.name,
                        "topic '" + name + "' is published with two different QoS");
    }
  }

  void check_request(const ComponentSpec& component, const std::string& name,
                     const msgs::Qos& qos) const {
    const auto it = offers_.find(name);
    if (it == offers_.end()) return;
    for (const msgs::Qos& offered : it->second) {
      if (const std::string text = incompatibility(offered, qos); !text.empty()) {
        throw ConfigError(component.where, component.name,
                          "topic '" + name + "': incompatible QoS: " + text);
      }
    }
  }

  struct Request {
    const ComponentSpec* component;
    PortInfo port;
  };
  std::map<std::string, Connection> connections_;
  std::map<std::string, std::vector<msgs::Qos>> offers_;
  std::map<std::string, std::vector<Request>> requests_;
};

}  // namespace

std::string resolved_topic(const ComponentSpec& component, const msgs::Topic& port) {
  const auto it = component.remaps.find(std::string(port.name));
  return it == component.remaps.end() ? std::string(port.name) : it->second;
}

std::vector<GivenParameter> parameters_of(const ComponentSpec& component, const GraphSpec& graph,
                                          const Description& description) {
  std::vector<GivenParameter> given = component.parameters;
  for (const GivenParameter& parameter : graph.common) {
    const bool own = std::ranges::any_of(
        given, [&](const GivenParameter& g) { return g.name == parameter.name; });
    if (!own && declares(description, parameter.name)) given.push_back(parameter);
  }
  return given;
}

std::vector<Connection> check_graph(const GraphSpec& graph, Registry& registry) {
  Wiring wiring;
  SharedParameters shared;
  std::set<std::string> names;
  std::set<std::string> known_common;
  for (const ComponentSpec& component : graph.components) {
    if (!names.insert(component.name).second) {
      throw ConfigError(component.where, component.name, "is given twice");
    }
    if (!component.library.empty()) registry.load_library(component.library);
    const SourceLocation& class_where =
        component.class_where.file.empty() ? component.where : component.class_where;
    const ComponentClass& type = registry.find(component.class_name, class_where);
    check_component_parameters(component, graph, type.description);
    shared.add(component, graph, type.description);
    check_remaps(component, type.description);
    for (const GivenParameter& parameter : graph.common) {
      if (declares(type.description, parameter.name)) known_common.insert(parameter.name);
    }
    for (const PortInfo& port : type.description.outputs()) wiring.add(component, port, true);
    for (const PortInfo& port : type.description.inputs()) wiring.add(component, port, false);
  }
  for (const GivenParameter& parameter : graph.common) {
    if (!known_common.contains(parameter.name)) {
      throw ConfigError(parameter.where, "common." + parameter.name,
                        "no component declares this parameter");
    }
  }
  wiring.check(graph);
  return wiring.connections();
}

}  // namespace furrow::graph
