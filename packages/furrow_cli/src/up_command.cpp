#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.hpp"
#include "furrow_dds/dds_parameters.hpp"
#include "furrow_dds/discovery_server.hpp"
#include "furrow_graph/graph_check.hpp"
#include "graph_setup.hpp"
#include "run_options.hpp"
#include "run_recordings.hpp"
#include "share.hpp"
#include "supervisor.hpp"
#include "supervisor_wire.hpp"

namespace furrow::cli {
namespace {

struct UpOptions {
  RunOptions run;
  std::string host;
  bool resume = false;
};

std::string pick_host(const graph::DeploymentSpec& deployment, const std::string& wanted) {
  std::string names;
  for (const graph::HostSpec& host : deployment.hosts) {
    if (host.name == wanted) return wanted;
    names += (names.empty() ? "" : ", ") + host.name;
  }
  if (wanted.empty() && deployment.hosts.empty()) return "";
  throw ConfigError(deployment.where, "hosts",
                    names.empty()    ? "there are none: leave --host away"
                    : wanted.empty() ? "name this one with --host: " + names
                                     : "there is no '" + wanted + "', only: " + names);
}

/// Where the deployment's processes find each other, when that is this host.
std::unique_ptr<dds::DiscoveryServer> make_discovery_server(const graph::DeploymentSpec& deployment,
                                                            const std::string& host,
                                                            const dds::DdsParameters& wire) {
  if (wire.discovery != "discovery_server" || deployment.hosts.empty() ||
      deployment.hosts.front().name != host || wire.peers.empty()) {
    return nullptr;
  }
  return std::make_unique<dds::DiscoveryServer>(wire.domain_id, wire.peers.front());
}

int up(const UpOptions& options) {
  graph::Registry registry = make_registry();
  const PreparedGraph prepared = prepare_run(options.run, registry);
  (void)graph::check_graph(prepared.spec, registry);
  const auto deployment = prepare_deployment(options.run);
  const auto placed = graph::place_components(prepared.spec, deployment);
  const std::string host = pick_host(deployment, options.host);
  dds::DdsParameters wire;
  ParameterLoader::load(graph::wire_of(deployment, host), wire);
  check_out_folder(options.run.out);

  const auto scores = [&](const graph::PlacedProcess& process) {
    return std::ranges::any_of(prepared.spec.components, [&](const auto& component) {
      return component.class_name == "scorer" &&
             std::ranges::find(process.components, component.name) != process.components.end();
    });
  };
  std::vector<SupervisedProcess> processes;
  for (const graph::PlacedProcess& process : placed) {
    if (process.host != host) continue;
    std::vector<std::string> command = {std::filesystem::read_symlink("/proc/self/exe").string()};
    std::ranges::copy(arguments_of(options.run), std::back_inserter(command));
    command.push_back("--process=" + process.name);
    processes.push_back({.name = process.name,
                         .command = std::move(command),
                         .restart = process.restart && !options.run.lockstep(),
                         .reports = scores(process)});
  }
  const auto server = make_discovery_server(deployment, host, wire);
  SupervisorWire watch(wire, options.resume);
  Supervisor supervisor(std::move(processes), [&watch] { return watch.tick(); });
  return supervisor.run();
}

}  // namespace

void add_up_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<UpOptions>();
  options->run.deploy = "distributed";
  CLI::App* command = app.add_subcommand(
      "up", "Runs all processes of a deployment that live on this host, and keeps them running.");
  add_run_options(*command, options->run);
  command->add_option("--host", options->host, "which host of the deployment this is");
  command->add_flag("--resume", options->resume,
                    "let tools start again that made themselves safe because a process or host was "
                    "gone; otherwise a message on tool/reset must");
  command->callback([options, &exit_code] { exit_code = up(*options); });
}

}  // namespace furrow::cli
