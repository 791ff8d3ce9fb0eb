#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <thread>

#include "command.hpp"
#include "console.hpp"
#include "diagnostics_table.hpp"
#include "furrow_components/application_record.hpp"
#include "furrow_components/field_conversion.hpp"
#include "furrow_components/run_record_conversion.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "graph_setup.hpp"
#include "run_observer.hpp"
#include "run_options.hpp"
#include "run_recordings.hpp"
#include "run_summary.hpp"
#include "share.hpp"
#include "signals.hpp"
#include "wire_health.hpp"

namespace furrow::cli {
namespace {

/// What concerns this process alone.
struct ProcessOptions {
  RunOptions run;
  std::string process;
  bool no_wire = false;
};

const graph::PlacedProcess& pick_process(const std::vector<graph::PlacedProcess>& placed,
                                         const graph::DeploymentSpec& deployment,
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

std::unique_ptr<dds::DdsTransport> make_transport(const ProcessOptions& options,
                                                  const graph::DeploymentSpec& deployment,
                                                  const graph::PlacedProcess& process, bool alone) {
  dds::DdsParameters parameters;
  parameters.process_name = process.name;
  ParameterLoader::load(graph::wire_of(deployment, process.host), parameters);
  if (options.no_wire && !alone) {
    throw ConfigError(deployment.where, "processes",
                      "there are several, which cannot do with --no-wire");
  }
  if (options.no_wire) return nullptr;
  return std::make_unique<dds::DdsTransport>(parameters);
}

bool contains(const std::vector<std::string>& list, const std::string& entry) {
  return std::find(list.begin(), list.end(), entry) != list.end();
}

geometry::ToolModel tool_of(const PreparedGraph& prepared) {
  const std::string file = graph::common_text(prepared.spec, "tool_file");
  return file.empty() ? geometry::ToolModel() : geometry::load_tool_model(file);
}

/// Adds what the command knows of a run to its record.
void complete_record(ledger::RunRecord& record, const furrow_msgs::msg::RunRecord& message,
                     const PreparedGraph& prepared, const RunOptions& options,
                     const std::vector<graph::ComponentStatus>& components, double wall_s) {
  record.info.simulated = !message.field().source().empty();
  record.info.seed = options.seed;
  record.info.version = FURROW_VERSION;
  record.info.graph = prepared.spec.name;
  record.info.wall_s = wall_s;
  const bool real = !options.lockstep();
  record.info.more = {{"clock", options.clock},
                      {"messages dropped", std::to_string(dropped_messages(components))}};
  const geometry::ToolModel tool = tool_of(prepared);
  const auto applications = components::applications_of(message, tool);
  record.tables = components::use_tables(message, applications, tool);
  for (ledger::ReportTable& table : health_tables(components, real)) {
    record.tables.push_back(std::move(table));
  }
}

Status write_as_applied(const furrow_msgs::msg::RunRecord& message, const PreparedGraph& prepared,
                        const RunOptions& options) {
  return components::write_as_applied(options.out, message,
                                      components::applications_of(message, tool_of(prepared)));
}

int write_report(const ledger::RunRecord& record, const field::FieldModel& field,
                 const RunOptions& options, std::uint64_t dropped,
                 const std::vector<std::string>& not_well) {
  const auto ledger = ledger::account(field, record);
  if (!ledger.ok()) {
    std::cerr << "furrow: the run cannot be accounted for: " << ledger.error().message << '\n';
    return 1;
  }
  const Status written = ledger::write_run_files(options.out, *ledger, record);
  if (!written.ok()) {
    std::cerr << "furrow: " << written.error().message << '\n';
    return 1;
  }
  std::cout << '\n'
            << ledger->summary.field << " (" << ledger->summary.source << ")\n"
            << outcome_text(ledger->summary, dropped);
  if (!not_well.empty()) std::cout << "\nnot well at the end:\n";
  for (const std::string& line : not_well) std::cout << "  " << line << '\n';
  std::cout << "\nreport: " << (std::filesystem::path(options.out) / "report.html").string()
            << '\n';
  return 0;
}

bool has_scorer(const graph::GraphSpec& graph, const std::vector<std::string>& components) {
  return std::ranges::any_of(graph.components, [&](const auto& component) {
    return component.class_name == "scorer" && contains(components, component.name);
  });
}

RunEnd end_of(const graph::GraphSpec& graph, const std::vector<graph::PlacedProcess>& placed,
              const graph::PlacedProcess& mine, bool lockstep) {
  if (has_scorer(graph, mine.components)) return RunEnd::kRecord;
  const bool scored = std::ranges::any_of(
      placed, [&](const auto& process) { return has_scorer(graph, process.components); });
  // In lock-step all processes end in the same wave, with the one that has the record.
  return scored && lockstep ? RunEnd::kNever : RunEnd::kStatus;
}

/// Waits, in real time, until the other processes are there, so that nothing of the start is lost.
void wait_for_others(const graph::Runtime& runtime, const std::atomic<bool>& interrupted) {
  constexpr std::chrono::seconds kPatience{10};
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!runtime.connected() && !interrupted) {
    if (std::chrono::steady_clock::now() > deadline) {
      std::cerr << "furrow: starting although not all other processes are there\n";
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int run(const ProcessOptions& process_options) {
  const RunOptions& options = process_options.run;
  graph::Registry registry = make_registry();
  PreparedGraph prepared = prepare_run(options, registry);
  const auto deployment = prepare_deployment(options);
  const auto placed = graph::place_components(prepared.spec, deployment);
  const graph::PlacedProcess& process = pick_process(placed, deployment, process_options.process);
  check_out_folder(options.out);

  ProgressBar bar("weeding");
  const RunEnd end = end_of(prepared.spec, placed, process, options.lockstep());
  const bool several = placed.size() > 1;
  const bool shows = !several || end == RunEnd::kRecord;
  RunObserver observer(
      [&bar, shows](const furrow_msgs::msg::RunStatus& status) {
        if (!shows) return;
        bar.show(status.progress(),
                 number(status.distance_m(), 1) + " m, " + number(status.speed_mps(), 2) + " m/s");
      },
      end, several && end == RunEnd::kRecord && !options.lockstep());
  observer.add_to(prepared.spec, registry);
  std::vector<std::string> mine = process.components;
  mine.emplace_back(RunObserver::component_name());

  std::atomic<graph::Runtime*> running = nullptr;
  std::atomic<bool> interrupted = false;
  SignalWatch signals([&] {
    interrupted = true;
    if (graph::Runtime* runtime = running) runtime->request_stop("interrupted");
  });
  const auto transport = make_transport(process_options, deployment, process, !several);
  std::unique_ptr<WireHealth> wire_health;
  std::function<graph::Health()> look;
  if (transport != nullptr) {
    wire_health = std::make_unique<WireHealth>(*transport);
    look = [&wire_health] { return wire_health->look(); };
  }
  graph::Runtime runtime(
      prepared.spec, registry,
      {.clock = options.lockstep() ? graph::ClockMode::kLockstep : graph::ClockMode::kReal,
       .threads = options.threads,
       .seed = static_cast<std::uint64_t>(options.seed),
       .components = mine,
       .transport = transport.get(),
       .process = process.name,
       .processes = placed,
       .wire_health = look});
  running = &runtime;
  if (interrupted) runtime.request_stop("interrupted");
  if (!options.lockstep()) wait_for_others(runtime, interrupted);
  const auto start = std::chrono::steady_clock::now();
  const graph::RunResult result = runtime.run();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  bar.finish();
  running = nullptr;

  if (result.failed || result.reason != "finished") {
    std::cerr << "furrow: the run ended early: " << result.reason << '\n';
    return 1;
  }
  if (end != RunEnd::kRecord || observer.record() == nullptr) return 0;
  if (const Status written = write_as_applied(*observer.record(), prepared, options); !written) {
    std::cerr << "furrow: " << written.error().message << '\n';
    return 1;
  }
  const auto field = components::from_msg(observer.record()->field());
  const auto components = runtime.status();
  auto record = components::from_msg(*observer.record(), prepared.axes);
  if (!record.ok()) {
    std::cerr << "furrow: run/record: " << record.error().message << '\n';
    return 1;
  }
  complete_record(*record, *observer.record(), prepared, options, components, wall.count());
  std::vector<std::string> unwell = not_well(components);
  if (!observer.diagnostics().empty()) {
    record->tables.push_back(diagnostics_table(observer.diagnostics(), process.name));
    std::ranges::move(not_well(observer.diagnostics(), process.name), std::back_inserter(unwell));
  }
  return write_report(*record, field, options, dropped_messages(components), unwell);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ProcessOptions>();
  CLI::App* command = app.add_subcommand("run", "Runs a graph and writes its report.");
  add_run_options(*command, options->run);
  command->add_option("--process", options->process, "which process of the deployment this one is");
  command->add_flag("--no-wire", options->no_wire, "do not join the DDS domain");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace furrow::cli
