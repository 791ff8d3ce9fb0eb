#include "furrow_launch/run_session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_core/error.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/run_graph.hpp"
#include "furrow_launch/transport_health.hpp"

namespace furrow::launch {
namespace {

using SteadyClock = std::chrono::steady_clock;

// One step of a rendered run takes a while on a busy computer.
constexpr std::chrono::seconds kPatienceWithInterrupt{5};

const graph::PlacedProcess& pick_process(const std::vector<graph::PlacedProcess>& placed,
                                         const configuration::DeploymentSpec& deployment,
                                         const std::string& wanted) {
  if (wanted.empty() && placed.size() == 1) return placed.front();
  std::string names;
  for (const graph::PlacedProcess& process : placed) {
    if (process.name == wanted) return process;
    names += (names.empty() ? "" : ", ") + process.name;
  }
  throw ConfigError(deployment.where, "processes",
                    wanted.empty()
                        ? "run all with `furrow up`, or name one with --process: " + names
                        : "there is no process '" + wanted + "', only: " + names);
}

bool has_scorer(const graph::GraphSpec& graph, const std::vector<std::string>& components) {
  return std::ranges::any_of(graph.components, [&](const auto& component) {
    return component.class_name == "scorer" &&
           std::ranges::find(components, component.name) != components.end();
  });
}

RunEnd end_of(const graph::GraphSpec& graph, const std::vector<graph::PlacedProcess>& placed,
              const graph::PlacedProcess& own, bool lockstep) {
  if (has_scorer(graph, own.components)) return RunEnd::kRecord;
  const bool scored = std::ranges::any_of(
      placed, [&](const auto& process) { return has_scorer(graph, process.components); });
  // In lock-step all processes end in the same step, with the one that has the record.
  return scored && lockstep ? RunEnd::kNever : RunEnd::kStatus;
}

/// Waits, in real time, until the other processes are there, so that no message of the start is
/// lost. False when they did not come in time.
bool wait_for_others(const graph::Runtime& runtime, const std::atomic<bool>& interrupted) {
  constexpr std::chrono::seconds kPatience{10};
  const auto deadline = SteadyClock::now() + kPatience;
  while (!runtime.connected() && !interrupted) {
    if (SteadyClock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace

RunSession::RunSession(const RunOptions& options, const std::string& process, bool use_dds)
    : options_(options),
      use_dds_(use_dds),
      registry_(make_registry()),
      prepared_(prepare_run(options, registry_)),
      deployment_(prepare_deployment(options)),
      placed_(configuration::place_components(prepared_.spec, deployment_)),
      process_(pick_process(placed_, deployment_, process)),
      end_(end_of(prepared_.spec, placed_, process_, options.lockstep())) {
  (void)graph::check_graph(prepared_.spec, registry_);
  (void)dds_parameters();
  check_external_inputs();
  if (!use_dds_ && placed_.size() > 1) {
    throw ConfigError(deployment_.where, "processes",
                      "--no-dds needs a single-process deployment; this one has " +
                          std::to_string(placed_.size()) + " processes");
  }
}

void RunSession::check_external_inputs() {
  std::string missing;
  for (const ExternalInput& input : external_inputs(prepared_.spec, registry_)) {
    if (input.required) missing += (missing.empty() ? "" : ", ") + input.topic;
  }
  if (missing.empty() || (use_dds_ && !options_.lockstep())) return;
  throw ConfigError(prepared_.spec.where, "external",
                    std::string(use_dds_ ? "--clock lockstep" : "--no-dds") + ": graph '" +
                        prepared_.spec.name + "' reads " + missing +
                        " from the drivers of a robot; play them with --recording, or run with "
                        "--clock real and without --no-dds");
}

std::vector<ExternalInput> RunSession::inputs_of_process() {
  std::vector<ExternalInput> inputs = external_inputs(prepared_.spec, registry_);
  for (ExternalInput& input : inputs) {
    std::erase_if(input.readers, [this](const std::string& reader) {
      return std::ranges::find(process_.components, reader) == process_.components.end();
    });
  }
  std::erase_if(inputs, [](const ExternalInput& input) { return input.readers.empty(); });
  return inputs;
}

dds::DdsParameters RunSession::dds_parameters() const {
  dds::DdsParameters parameters;
  parameters.process_name = process_.name;
  ParameterLoader::load(configuration::transport_parameters(deployment_, process_.host),
                        parameters);
  return parameters;
}

graph::RuntimeOptions RunSession::runtime_options() const {
  graph::RuntimeOptions options;
  options.clock = options_.lockstep() ? graph::ClockMode::kLockstep : graph::ClockMode::kReal;
  options.threads = options_.threads;
  options.seed = static_cast<std::uint64_t>(options_.seed);
  options.components = process_.components;
  options.components.emplace_back(RunObserver::component_name());
  options.process = process_.name;
  options.processes = placed_;
  return options;
}

RunOutcome RunSession::run(SignalPipe& signals, const Callbacks& callbacks) {
  const bool several = placed_.size() > 1;
  RunObserver observer(callbacks.progress, end_, several && reports() && !options_.lockstep());
  graph::GraphSpec spec = prepared_.spec;
  observer.add_to(spec, registry_);
  graph::RuntimeOptions runtime_options = this->runtime_options();
  runtime_options.log = callbacks.log;
  std::unique_ptr<dds::DdsTransport> transport;
  std::optional<TransportHealth> health;
  if (use_dds_) {
    transport = std::make_unique<dds::DdsTransport>(dds_parameters());
    health.emplace(*transport, inputs_of_process());
    runtime_options.transport = transport.get();
    runtime_options.transport_health = [&health] { return health->look(); };
  }
  graph::Runtime runtime(spec, registry_, runtime_options);
  std::atomic<bool> interrupted = false;
  const SignalWatch watch(
      signals,
      [&](int call) {
        interrupted = true;
        if (call == 1 && reports()) {
          observer.interrupt();
        } else {
          runtime.request_stop("interrupted");
        }
      },
      kPatienceWithInterrupt);
  if (!options_.lockstep() && !wait_for_others(runtime, interrupted)) {
    callbacks.warn("not all other processes were found within 10 s; the run starts without them");
  }
  const auto start = SteadyClock::now();
  RunOutcome outcome;
  outcome.result = runtime.run();
  outcome.wall_s = std::chrono::duration<double>(SteadyClock::now() - start).count();
  outcome.interrupted = interrupted;
  outcome.process = process_.name;
  outcome.record = observer.record();
  outcome.components = runtime.status();
  outcome.diagnostics = observer.diagnostics();
  return outcome;
}

}  // namespace furrow::launch
