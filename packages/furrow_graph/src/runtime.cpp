#include "furrow_graph/runtime.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "diagnostics.hpp"
#include "executor.hpp"
#include "furrow_core/hash.hpp"
#include "furrow_graph/graph_check.hpp"
#include "rosout.hpp"

namespace furrow::graph {

namespace {

/// Deadlines and leases are of the wall clock, which simulated time does not follow.
msgs::Qos transport_qos(msgs::Qos qos, ClockMode clock) {
  if (clock == ClockMode::kReal) return qos;
  qos.deadline = Duration();
  qos.liveliness_lease = Duration();
  return qos;
}

}  // namespace

struct Runtime::Impl {
  std::vector<Connection> connections;
  std::unique_ptr<Executor> executor;
  std::map<std::string, std::unique_ptr<Route>> routes;
  std::vector<std::unique_ptr<Node>> nodes;
  struct Incoming {
    std::unique_ptr<TransportReader> reader;
    int writers = 0;  ///< the number of other processes that publish the topic
  };
  std::vector<Incoming> incoming;
  std::vector<const Route*> outgoing;  ///< read by other processes of the deployment
  std::map<std::string, std::string> process_of;
  std::unique_ptr<TransportWriter> diagnostics_writer;
  std::vector<Route::Reader> diagnostics_readers;
  log::Log* log = nullptr;
  std::shared_ptr<log::Sink> rosout;

  ~Impl() {
    if (rosout != nullptr) log->remove(*rosout);
    // Readers first, so that no message arrives for a destroyed node.
    incoming.clear();
    for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) (*it)->destroy_component();
  }

  [[nodiscard]] bool is_local(const std::string& name) const {
    return std::ranges::any_of(nodes, [&](const auto& node) { return node->name() == name; });
  }

  [[nodiscard]] std::vector<Route::Reader> readers_of(const std::string& topic) const {
    std::vector<Route::Reader> readers;
    for (const auto& node : nodes) {
      if (const auto input = node->input_of(topic)) readers.push_back({node.get(), *input});
    }
    return readers;
  }

  /// The other processes of the deployment with one of these components.
  [[nodiscard]] std::set<std::string> elsewhere(const std::vector<std::string>& components,
                                                const std::string& own) const {
    std::set<std::string> processes;
    for (const std::string& component : components) {
      const auto it = process_of.find(component);
      if (it != process_of.end() && it->second != own) processes.insert(it->second);
    }
    return processes;
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
      nodes.back()->set_log(options.log);
    }
    for (const std::string& name : options.components) {
      if (!is_local(name)) throw ConfigError("the graph has no component '" + name + "'");
    }
  }

  void make_routes(const RuntimeOptions& options) {
    Transport* transport = options.transport;
    for (std::size_t i = 0; i < connections.size(); ++i) {
      const Connection& connection = connections[i];
      const bool publishes =
          std::ranges::any_of(connection.publishers, [&](const auto& p) { return is_local(p); });
      if (!publishes) continue;
      auto route = std::make_unique<Route>();
      route->qos = connection.qos;
      route->topic_index = static_cast<std::uint32_t>(i);
      if (transport != nullptr) {
        route->writer = transport->make_writer(connection.topic, *connection.type,
                                               transport_qos(connection.qos, options.clock));
        if (!elsewhere(connection.readers, options.process).empty())
          outgoing.push_back(route.get());
      }
      routes.emplace(connection.topic, std::move(route));
    }
  }

  void connect(const RuntimeOptions& options, bool shared) {
    Transport* transport = options.transport;
    for (const Connection& connection : connections) {
      const std::vector<Route::Reader> readers = readers_of(connection.topic);
      if (readers.empty()) continue;
      if (const auto route = routes.find(connection.topic); route != routes.end()) {
        route->second->readers = readers;
      }
      // Read topics of other processes, and those without a publisher in the graph.
      const bool all_local =
          !connection.publishers.empty() &&
          std::ranges::all_of(connection.publishers, [&](const auto& p) { return is_local(p); });
      // In a shared lock-step, step messages carry the topics of the graph.
      if (transport == nullptr || all_local || (shared && !connection.publishers.empty())) continue;
      auto reader = transport->make_reader(connection.topic, *connection.type, connection.qos,
                                           [this, readers](MessagePtr message) {
                                             for (const Route::Reader& to : readers)
                                               executor->deliver_from_transport(to, message);
                                           });
      incoming.push_back(
          {std::move(reader),
           static_cast<int>(elsewhere(connection.publishers, options.process).size())});
    }
  }

  [[nodiscard]] std::vector<ComponentStatus> status() const {
    std::vector<ComponentStatus> list;
    for (const auto& node : nodes) {
      if (!node->spec().everywhere) list.push_back(node->status());
    }
    return list;
  }

  /// Publishes the log, as ROS 2 nodes do.
  void publish_log(const RuntimeOptions& options) {
    if (options.log == nullptr) return;
    const msgs::Topic& topic = msgs::topics::Rosout::topic();
    std::unique_ptr<TransportWriter> writer;
    if (options.transport != nullptr) {
      writer = options.transport->make_writer(std::string(topic.name), *topic.type, topic.qos);
    }
    rosout = make_rosout_sink(
        std::move(writer),
        [this, readers = readers_of(std::string(topic.name))](const MessagePtr& message) {
          for (const Route::Reader& reader : readers) {
            executor->deliver_from_transport(reader, message);
          }
        },
        options.clock == ClockMode::kReal);
    log->add(rosout);
  }

  void diagnose(const RuntimeOptions& options) {
    const msgs::Topic& topic = msgs::topics::Diagnostics::topic();
    if (options.transport != nullptr) {
      diagnostics_writer =
          options.transport->make_writer(std::string(topic.name), *topic.type, topic.qos);
    }
    diagnostics_readers = readers_of(std::string(topic.name));
    if (diagnostics_writer == nullptr && diagnostics_readers.empty()) return;
    const bool real = options.clock == ClockMode::kReal;
    executor->every_second([this, process = options.process,
                            transport_health = options.transport_health, real](Time now) {
      const Health transport = transport_health && real ? transport_health() : Health();
      if (log != nullptr && transport.level != HealthLevel::kOk) {
        log->write(now, log::Level::kWarn, "transport", transport.message);
      }
      const bool outside = diagnostics_writer != nullptr && diagnostics_writer->has_readers();
      if (!outside && diagnostics_readers.empty()) return;
      const auto message =
          std::make_shared<const diagnostic_msgs::msg::DiagnosticArray>(make_diagnostics(
              now, process, status(), transport_health && real ? &transport : nullptr, real));
      for (const Route::Reader& reader : diagnostics_readers) {
        executor->deliver_from_transport(reader, message);
      }
      if (outside) diagnostics_writer->write(message);
    });
  }

  [[nodiscard]] std::unique_ptr<SharedLockstep> make_shared_lockstep(const GraphSpec& graph,
                                                                     const RuntimeOptions& options);
};

namespace {

/// FNV-1a of the settings that all processes of a lock-step must share. Paths may differ by host.
std::uint64_t digest_of(const GraphSpec& graph, const std::vector<Connection>& connections,
                        const RuntimeOptions& options) {
  std::string text = std::to_string(options.seed) + "\n";
  const auto add = [&text](const std::vector<GivenParameter>& parameters) {
    for (const auto& [name, value, where] : parameters) {
      if (name.ends_with("_file") || name.ends_with("_folder")) continue;
      text += name + "=" + to_text(value) + "\n";
    }
  };
  for (const ComponentSpec& component : graph.components) {
    text += component.name + " " + component.class_name + "\n";
    add(component.parameters);
  }
  add(graph.common);
  for (const Connection& connection : connections) text += connection.topic + "\n";
  for (const PlacedProcess& process : options.processes) {
    text += process.name + ":";
    for (const std::string& component : process.components) text += " " + component;
    text += "\n";
  }
  return fnv1a_64(text);
}

}  // namespace

std::unique_ptr<SharedLockstep> Runtime::Impl::make_shared_lockstep(const GraphSpec& graph,
                                                                    const RuntimeOptions& options) {
  auto shared = std::make_unique<SharedLockstep>();
  std::vector<std::string> processes;
  for (const PlacedProcess& process : options.processes) processes.push_back(process.name);
  for (const auto& node : nodes) {
    const auto it = std::ranges::find(graph.components, node->name(), &ComponentSpec::name);
    shared->component_of_node.push_back(static_cast<std::uint32_t>(it - graph.components.begin()));
  }
  std::set<std::string> everywhere;
  for (const ComponentSpec& component : graph.components) {
    if (component.everywhere) everywhere.insert(component.name);
  }
  for (const Connection& connection : connections) {
    SharedLockstep::Topic topic;
    topic.type = connection.type;
    topic.readers = readers_of(connection.topic);
    topic.read_by.assign(processes.size(), false);
    for (const std::string& reader : connection.readers) {
      if (everywhere.contains(reader)) topic.read_by.assign(processes.size(), true);
      const auto process = process_of.find(reader);
      if (process == process_of.end()) continue;
      const auto it = std::ranges::find(processes, process->second);
      topic.read_by[static_cast<std::size_t>(it - processes.begin())] = true;
    }
    for (std::size_t i = 0; i < processes.size(); ++i) {
      if (topic.read_by[i] && processes[i] != options.process) topic.read_elsewhere = true;
    }
    shared->topics.push_back(std::move(topic));
  }
  shared->exchange = std::make_unique<StepExchange>(*options.transport, processes, options.process,
                                                    digest_of(graph, connections, options));
  return shared;
}

Runtime::Runtime(const GraphSpec& graph, Registry& registry, const RuntimeOptions& options)
    : impl_(std::make_unique<Impl>()) {
  if (options.threads < 1) throw ConfigError("threads: must be at least 1");
  impl_->log = options.log;
  impl_->connections = check_graph(graph, registry);
  impl_->executor = options.clock == ClockMode::kLockstep ? make_lockstep_executor(options.threads)
                                                          : make_realtime_executor(options.threads);
  for (const PlacedProcess& process : options.processes) {
    for (const std::string& component : process.components) {
      impl_->process_of[component] = process.name;
    }
  }
  impl_->make_nodes(graph, registry, options);
  impl_->make_routes(options);
  for (const auto& node : impl_->nodes) {
    node->construct(
        [this](const std::string& topic) -> Route& { return *impl_->routes.at(topic); });
  }
  const bool shared = options.clock == ClockMode::kLockstep && options.processes.size() > 1;
  impl_->connect(options, shared);
  impl_->diagnose(options);
  impl_->publish_log(options);
  if (shared) {
    if (options.transport == nullptr)
      throw ConfigError("a lock-step of several processes requires a transport");
    impl_->executor->share(impl_->make_shared_lockstep(graph, options));
  }
}

Runtime::~Runtime() = default;

RunResult Runtime::run() {
  return impl_->executor->run(impl_->nodes);
}

void Runtime::request_stop(std::string_view reason) {
  impl_->executor->interrupt(reason);
}

std::vector<ComponentStatus> Runtime::status() const {
  return impl_->status();
}

bool Runtime::connected() const {
  return std::ranges::all_of(impl_->incoming,
                             [](const auto& in) { return in.reader->writers() >= in.writers; }) &&
         std::ranges::all_of(impl_->outgoing,
                             [](const Route* route) { return route->writer->has_readers(); });
}

}  // namespace furrow::graph
