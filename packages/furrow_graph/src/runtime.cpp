#include "furrow_graph/runtime.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "executor.hpp"
#include "furrow_graph/graph_check.hpp"

namespace furrow::graph {

struct Runtime::Impl {
  std::vector<Connection> connections;
  std::unique_ptr<Executor> executor;
  std::map<std::string, std::unique_ptr<Route>> routes;
  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<std::unique_ptr<WireReader>> wire_readers;

  ~Impl() {
    // Readers first: nothing may arrive for a node that is gone.
    wire_readers.clear();
    for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) (*it)->destroy_component();
  }

  [[nodiscard]] bool is_local(const std::string& name) const {
    return std::ranges::any_of(nodes, [&](const auto& node) { return node->name() == name; });
  }

  void make_nodes(const GraphSpec& graph, Registry& registry, const RuntimeOptions& options) {
    for (const ComponentSpec& spec : graph.components) {
      const bool mine =
          options.components.empty() ||
          std::ranges::find(options.components, spec.name) != options.components.end();
      if (!mine) continue;
      const ComponentClass& type = registry.find(spec.class_name, spec.where);
      nodes.push_back(std::make_unique<Node>(
          spec, type, parameters_of(spec, graph, type.description), options.seed, *executor));
    }
    for (const std::string& name : options.components) {
      if (!is_local(name)) throw ConfigError("the graph has no component '" + name + "'");
    }
  }

  void make_routes(Transport* transport) {
    for (const Connection& connection : connections) {
      const bool publishes =
          std::ranges::any_of(connection.publishers, [&](const auto& p) { return is_local(p); });
      if (!publishes) continue;
      auto route = std::make_unique<Route>();
      route->topic = connection.topic;
      route->qos = connection.qos;
      if (transport != nullptr) {
        route->wire = transport->make_writer(connection.topic, *connection.type, connection.qos);
      }
      routes.emplace(connection.topic, std::move(route));
    }
  }

  void connect(Transport* transport) {
    for (const Connection& connection : connections) {
      std::vector<Route::Reader> readers;
      for (const auto& node : nodes) {
        if (const auto input = node->input_of(connection.topic))
          readers.push_back({node.get(), *input});
      }
      if (readers.empty()) continue;
      if (const auto route = routes.find(connection.topic); route != routes.end()) {
        route->second->readers = readers;
      }
      // What another process publishes, or may: a topic without any publisher in the graph.
      const bool all_local =
          !connection.publishers.empty() &&
          std::ranges::all_of(connection.publishers, [&](const auto& p) { return is_local(p); });
      if (transport == nullptr || all_local) continue;
      wire_readers.push_back(transport->make_reader(
          connection.topic, *connection.type, connection.qos, [this, readers](MessagePtr message) {
            for (const Route::Reader& reader : readers)
              executor->deliver_from_wire(reader, message);
          }));
    }
  }
};

Runtime::Runtime(const GraphSpec& graph, Registry& registry, const RuntimeOptions& options)
    : impl_(std::make_unique<Impl>()) {
  if (options.threads < 1) throw ConfigError("threads: must be at least 1");
  impl_->connections = check_graph(graph, registry);
  impl_->executor = options.clock == ClockMode::kLockstep ? make_lockstep_executor(options.threads)
                                                          : make_realtime_executor(options.threads);
  impl_->make_nodes(graph, registry, options);
  impl_->make_routes(options.transport);
  for (const auto& node : impl_->nodes) {
    node->construct(
        [this](const std::string& topic) -> Route& { return *impl_->routes.at(topic); });
  }
  impl_->connect(options.transport);
}

Runtime::~Runtime() = default;

RunResult Runtime::run() {
  return impl_->executor->run(impl_->nodes);
}

void Runtime::request_stop(std::string_view reason) {
  impl_->executor->request_stop(reason, false);
}

std::vector<ComponentStatus> Runtime::status() const {
  std::vector<ComponentStatus> list;
  for (const auto& node : impl_->nodes) list.push_back(node->status());
  return list;
}

}  // namespace furrow::graph
