#include <chrono>
#include <csignal>
#include <iostream>
#include <memory>
#include <thread>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_diagnosis/domain_probe.hpp"
#include "furrow_diagnosis/report.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/signals.hpp"
#include "output_options.hpp"
#include "transport_options.hpp"

namespace furrow::cli {
namespace {

struct DoctorOptions {
  std::string graph = "observe";
  std::vector<std::string> settings;
  double seconds = 5.0;
  launch::TransportOptions transport;
  ResultOptions results;
};

constexpr int kCouldNotLook = 2;

/// False when a signal comes.
bool wait(double seconds, const launch::SignalPipe& signals) {
  using SteadyClock = std::chrono::steady_clock;
  const auto until = SteadyClock::now() + std::chrono::duration<double>(seconds);
  while (SteadyClock::now() < until) {
    if (signals.take() != 0) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

int look(const DoctorOptions& options) {
  ResultFiles files(options.results);
  graph::Registry registry = launch::make_registry();
  const launch::PreparedGraph prepared = launch::prepare_graph(options.graph, options.settings);
  (void)graph::check_graph(prepared.spec, registry);
  const auto setup = diagnosis::sensor_setup(prepared.spec, prepared.tool, registry);
  if (setup.inputs.empty()) {
    throw ConfigError(prepared.spec.where, "external",
                      "graph '" + prepared.spec.name +
                          "' reads no sensor of a robot; give --graph observe or robot");
  }
  const launch::SignalPipe signals({SIGINT, SIGTERM});
  const auto parameters = launch::transport_parameters(options.transport, "furrow_doctor");
  dds::DdsTransport transport(parameters);
  const diagnosis::DomainProbe probe(transport, setup);
  if (!wait(options.seconds, signals)) {
    std::cerr << "furrow: interrupted before " << options.seconds << " s were over\n";
    return kCouldNotLook;
  }
  auto seen = probe.observations(options.seconds);
  seen.only_this_host = parameters.interfaces == std::vector<std::string>{"127.0.0.1"};
  const auto diagnosis = diagnosis::diagnose(seen, setup.expectation);
  std::cout << diagnosis::report_text(seen, diagnosis);
  files.write_json(diagnosis::report_json(prepared.spec.name, seen, diagnosis));
  return diagnosis.findings.empty() ? 0 : 1;
}

int doctor(const DoctorOptions& options) {
  try {
    return look(options);
  } catch (const ConfigError&) {
    throw;  // 2, as every error of usage
  } catch (const std::exception& error) {
    std::cerr << "furrow: " << error.what() << '\n';
    return kCouldNotLook;
  }
}

}  // namespace

void add_doctor_command(Command root) {
  auto options = std::make_shared<DoctorOptions>();
  Command command = root.subcommand(
      "doctor",
      "Looks at a robot's sensors in the DDS domain, and says what to change before Furrow uses "
      "them. Exit code 1: findings; 2: it could not look.");
  command.option("--graph", options->graph, "graph file, or the name of a shipped graph");
  command.option("--seconds", options->seconds, "how long to look, s").range(0.5, 3600.0);
  command.option("--set", options->settings, "COMPONENT.KEY=VALUE overrides a parameter");
  add_result_options(command, options->results, false);
  add_transport_options(command, options->transport);
  command.on_run([options] { return doctor(*options); });
}

}  // namespace furrow::cli
