#include "furrow_supervisor/supervised_deployment.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_core/error.hpp"
#include "furrow_dds/discovery_server.hpp"
#include "furrow_dds/shared_memory_need.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/run_graph.hpp"
#include "furrow_log/sinks.hpp"
#include "furrow_supervisor/deployment_health.hpp"

namespace furrow::supervisor {
namespace {

constexpr char kLogName[] = "supervisor";

std::string pick_host(const configuration::DeploymentSpec& deployment, const std::string& wanted) {
  std::string names;
  for (const configuration::HostSpec& host : deployment.hosts) {
    if (host.name == wanted) return wanted;
    names += (names.empty() ? "" : ", ") + host.name;
  }
  if (wanted.empty() && deployment.hosts.empty()) return "";
  throw ConfigError(deployment.where, "hosts",
                    names.empty()    ? "there are none: leave --host away"
                    : wanted.empty() ? "name this one with --host: " + names
                                     : "there is no '" + wanted + "', only: " + names);
}

bool has_scorer(const graph::GraphSpec& graph, const graph::PlacedProcess& process) {
  return std::ranges::any_of(graph.components, [&](const auto& component) {
    return component.class_name == "scorer" &&
           std::ranges::find(process.components, component.name) != process.components.end();
  });
}

/// The drivers whose parameters name no folder for what they have latched.
std::vector<std::string> drivers_without_latches(const graph::GraphSpec& graph) {
  std::vector<std::string> names;
  for (const auto& component : graph.components) {
    const bool named = std::ranges::any_of(
        component.parameters, [](const auto& given) { return given.name == "latch_folder"; });
    if (component.class_name == "axis_driver" && !named) names.push_back(component.name);
  }
  return names;
}

/// Where the deployment's processes find each other, when that is this host.
std::unique_ptr<dds::DiscoveryServer> make_discovery_server(
    const configuration::DeploymentSpec& deployment, const std::string& host,
    const dds::DdsParameters& dds) {
  if (dds.discovery != "discovery_server" || deployment.hosts.empty() ||
      deployment.hosts.front().name != host || dds.peers.empty()) {
    return nullptr;
  }
  return std::make_unique<dds::DiscoveryServer>(dds.domain_id, dds.peers.front());
}

}  // namespace

SupervisedDeployment::SupervisedDeployment(launch::RunOptions options, const std::string& host)
    : options_(std::move(options)) {
  graph::Registry registry = launch::make_registry();
  const launch::PreparedGraph prepared = launch::prepare_run(options_, registry);
  (void)graph::check_graph(prepared.spec, registry);
  deployment_ = launch::prepare_deployment(options_);
  const auto placed = configuration::place_components(prepared.spec, deployment_);
  host_ = pick_host(deployment_, host);
  drivers_without_latches_ = drivers_without_latches(prepared.spec);
  ParameterLoader::load(configuration::transport_parameters(deployment_, host_), dds_);
  for (const graph::PlacedProcess& process : placed) {
    if (process.host != host_) continue;
    processes_.push_back({.name = process.name,
                          .restart = process.restart && !options_.lockstep(),
                          .reports = has_scorer(prepared.spec, process)});
  }
}

bool SupervisedDeployment::reports() const {
  return std::ranges::any_of(processes_, &Process::reports);
}

std::vector<SupervisedProcess> SupervisedDeployment::commands(
    const RunParameters& parameters) const {
  launch::RunOptions options = options_;
  options.out = parameters.out.string();
  std::vector<std::string> arguments = launch::run_arguments(options);
  // A process that is restarted finds what it had latched.
  const std::string latches = (parameters.out / "latches").string();
  for (const std::string& driver : drivers_without_latches_) {
    arguments.push_back("--set=" + driver + ".latch_folder=" + latches);
  }
  std::vector<SupervisedProcess> commands;
  for (const Process& process : processes_) {
    std::vector<std::string> command = {parameters.program.string()};
    std::ranges::copy(arguments, std::back_inserter(command));
    command.insert(command.end(), {"--process=" + process.name, "--supervised"});
    commands.push_back({.name = process.name,
                        .command = std::move(command),
                        .restart = process.restart,
                        .reports = process.reports});
  }
  return commands;
}

void SupervisedDeployment::open_logs(const std::filesystem::path& out, log::Log& own) const {
  std::error_code failure;
  std::filesystem::create_directories(out, failure);
  if (failure) throw ConfigError("--out: " + out.string() + ": " + failure.message());
  // Each process appends to its log, so that a restart keeps it.
  for (const Process& process : processes_) {
    const std::filesystem::path file = launch::log_file(out, process.name);
    std::filesystem::remove(file, failure);
    std::filesystem::remove(log::older_log(file), failure);
  }
  auto file = log::make_file_sink(launch::log_file(out, kLogName), log::Clock::kUnix);
  if (!file.ok()) throw ConfigError("--out: " + out.string() + ": " + file.error().message);
  own.add(*file);
}

int SupervisedDeployment::run(const RunParameters& parameters) const {
  dds::check_shared_memory(dds_, processes_.size());
  log::Log log({.repeat_period = Duration(), .now = log::unix_time});
  open_logs(parameters.out, log);
  const auto server = make_discovery_server(deployment_, host_, dds_);
  DeploymentHealth health(dds_, parameters.resume);
  std::size_t width = 0;
  for (const Process& process : processes_) width = std::max(width, process.name.size());
  Supervisor supervisor(commands(parameters),
                        {.on_tick = [&health] { return health.tick(); },
                         .show =
                             [&](const std::string& name, const std::string& text) {
                               std::string line(width, ' ');
                               line.replace(0, name.size(), name);
                               parameters.show(line + " | " + text);
                             },
                         .on_event =
                             [&log](const std::string& name, const std::string& text) {
                               log.write_foreign(log::Level::kWarn, kLogName,
                                                 name.empty() ? text : name + ": " + text);
                             },
                         .stop_reporter_first = options_.lockstep()});
  return supervisor.run();
}

}  // namespace furrow::supervisor
