#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "command.hpp"
#include "console.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/runtime.hpp"
#include "graph_setup.hpp"
#include "run_observer.hpp"
#include "run_summary.hpp"
#include "share.hpp"
#include "signals.hpp"

namespace furrow::cli {
namespace {

struct RunOptions {
  std::string graph = "weeding";
  std::string deploy = "composed";
  std::string process;
  std::vector<std::string> settings;
  std::string field;
  std::string ground;
  std::optional<double> length_m;
  std::uint64_t seed = 1;
  std::string clock = "real";
  int threads = 2;
  bool no_wire = false;
  std::string out = "out/run";
};

// The short options are settings of the graph with a shorter name.
std::vector<std::string> all_settings(const RunOptions& options) {
  std::vector<std::string> settings;
  if (!options.field.empty()) {
    const auto path = std::filesystem::absolute(find_shipped(options.field, "fields"));
    settings.push_back("common.field_file=" + path.string());
  }
  if (options.length_m) settings.push_back("common.length_m=" + number(*options.length_m, 6));
  constexpr std::string_view kPhotos = "photos:";
  if (options.ground.starts_with(kPhotos)) {
    const auto folder = std::filesystem::absolute(options.ground.substr(kPhotos.size()));
    settings.push_back("common.photos_folder=" + folder.string());
  } else if (!options.ground.empty() && options.ground != "rendered") {
    throw ConfigError("--ground: '" + options.ground + "' is neither rendered nor photos:DIR");
  }
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  return settings;
}

std::string pick_process(const RunOptions& options, const graph::DeploymentSpec& deployment) {
  if (options.process.empty() && deployment.processes.size() == 1) {
    return deployment.processes.front().name;
  }
  std::string names;
  for (const graph::ProcessSpec& process : deployment.processes) {
    if (process.name == options.process) return process.name;
    names += (names.empty() ? "" : ", ") + process.name;
  }
  throw ConfigError(deployment.where, "processes",
                    options.process.empty()
                        ? "name one with --process: " + names
                        : "there is no process '" + options.process + "', only: " + names);
}

std::unique_ptr<dds::DdsTransport> make_transport(const RunOptions& options,
                                                  const graph::DeploymentSpec& deployment,
                                                  const std::string& process) {
  if (options.no_wire) return nullptr;
  dds::DdsParameters parameters;
  parameters.process_name = process;
  ParameterLoader::load(deployment.wire, parameters);
  return std::make_unique<dds::DdsTransport>(parameters);
}

bool contains(const std::vector<std::string>& list, const std::string& entry) {
  return std::find(list.begin(), list.end(), entry) != list.end();
}

/// A folder that can be written to, before anything is run for it.
void check_out_folder(const std::string& out) {
  const std::filesystem::path path(out);
  if (std::filesystem::exists(path) && !std::filesystem::is_directory(path)) {
    throw ConfigError("--out: " + out + " is not a folder");
  }
}

ledger::RunRecord complete_record(const furrow_msgs::msg::RunRecord& message,
                                  const PreparedGraph& prepared, const RunOptions& options,
                                  const std::vector<graph::ComponentStatus>& components,
                                  double wall_s) {
  ledger::RunRecord record = components::from_msg(message, prepared.axes);
  record.info.simulated = !message.field().source().empty();
  record.info.seed = static_cast<std::int64_t>(options.seed);
  record.info.version = FURROW_VERSION;
  record.info.graph = prepared.spec.name;
  record.info.wall_s = wall_s;
  const bool real = options.clock == "real";
  record.info.more = {{"clock", options.clock},
                      {"messages dropped", std::to_string(dropped_messages(components))}};
  record.tables = health_tables(components, real);
  return record;
}

int write_report(const ledger::RunRecord& record, const field::FieldModel& field,
                 const RunOptions& options) {
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
            << outcome_text(ledger->summary)
            << "\nreport: " << (std::filesystem::path(options.out) / "report.html").string()
            << '\n';
  return 0;
}

int run(const RunOptions& options) {
  PreparedGraph prepared = prepare_graph(options.graph, all_settings(options));
  const auto deployment = graph::load_deployment(find_shipped(options.deploy, "deploy"));
  const std::string process = pick_process(options, deployment);
  std::vector<std::string> mine = graph::place_components(prepared.spec, deployment).at(process);
  check_out_folder(options.out);

  ProgressBar bar("weeding");
  const bool has_scorer = std::ranges::any_of(prepared.spec.components, [&](const auto& component) {
    return component.class_name == "scorer" && contains(mine, component.name);
  });
  RunObserver observer(
      [&bar](const furrow_msgs::msg::RunStatus& status) {
        bar.show(status.progress(),
                 number(status.distance_m(), 1) + " m, " + number(status.speed_mps(), 2) + " m/s");
      },
      has_scorer);
  graph::Registry registry = make_registry();
  observer.add_to(prepared.spec, registry);
  mine.emplace_back(RunObserver::component_name());

  graph::Runtime* running = nullptr;
  SignalWatch signals([&running] {
    if (running != nullptr) running->request_stop("interrupted");
  });
  const auto transport = make_transport(options, deployment, process);
  graph::Runtime runtime(
      prepared.spec, registry,
      {.clock = options.clock == "real" ? graph::ClockMode::kReal : graph::ClockMode::kLockstep,
       .threads = options.threads,
       .seed = options.seed,
       .components = mine,
       .transport = transport.get()});
  running = &runtime;
  const auto start = std::chrono::steady_clock::now();
  const graph::RunResult result = runtime.run();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  bar.finish();

  if (result.failed || result.reason != "finished") {
    std::cerr << "furrow: the run ended early: " << result.reason << '\n';
    return 1;
  }
  if (observer.record() == nullptr) return 0;
  const auto field = components::from_msg(observer.record()->field());
  return write_report(
      complete_record(*observer.record(), prepared, options, runtime.status(), wall.count()), field,
      options);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Runs a graph and writes its report.");
  command->add_option("--graph", options->graph, "graph file, or the name of a shipped one")
      ->capture_default_str();
  command->add_option("--deploy", options->deploy, "deployment file, or the name of a shipped one")
      ->capture_default_str();
  command->add_option("--process", options->process, "which process of the deployment this one is");
  command
      ->add_option("--set", options->settings,
                   "COMPONENT.KEY=VALUE over the files; common.KEY=VALUE for all components")
      ->take_all();
  command->add_option("--field", options->field,
                      "a shipped preset, a preset file, or plants as CSV or GeoJSON");
  command->add_option("--ground", options->ground, "rendered, or photos:DIR");
  command->add_option("--length", options->length_m, "metres of row");
  command->add_option("--seed", options->seed, "of everything that is random")
      ->capture_default_str();
  command->add_option("--clock", options->clock, "lockstep: as fast as it goes; real: real time")
      ->check(CLI::IsMember({"lockstep", "real"}))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "that call components")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_flag("--no-wire", options->no_wire, "do not join the DDS domain");
  command->add_option("--out", options->out, "folder of the report")->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace furrow::cli
