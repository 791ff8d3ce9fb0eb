#include "run_options.hpp"

#include <filesystem>
#include <limits>

#include "console.hpp"
#include "furrow_core/error.hpp"
#include "share.hpp"

namespace furrow::cli {

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("--graph", options.graph, "graph file, or the name of a shipped one")
      ->capture_default_str();
  command.add_option("--deploy", options.deploy, "deployment file, or the name of a shipped one")
      ->capture_default_str();
  command
      .add_option("--set", options.settings,
                  "COMPONENT.KEY=VALUE over the files; common.KEY=VALUE for all components")
      ->take_all();
  command
      .add_option("--wire", options.wire, "KEY=VALUE over the deployment's parameters of the wire")
      ->take_all();
  command.add_option("--address", options.addresses, "HOST=ADDRESS over those of the deployment")
      ->take_all();
  command.add_option("--field", options.field,
                     "a shipped preset, a preset file, or plants as CSV or GeoJSON");
  command.add_option("--ground", options.ground, "rendered, or photos:DIR");
  command.add_option("--length", options.length_m, "metres of row");
  command.add_option("--seed", options.seed, "of everything that is random")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str();
  command.add_option("--clock", options.clock, "lockstep: as fast as it goes; real: real time")
      ->check(CLI::IsMember({"lockstep", "real"}))
      ->capture_default_str();
  command.add_option("--threads", options.threads, "that call components")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_option("--out", options.out, "folder of the report")->capture_default_str();
  command.add_option("--record", options.record,
                     "record the topics of the run into this path with _0.mcap added; see the "
                     "parameters of recorder");
  command
      .add_option("--recording", options.recordings,
                  "play camera and odometry from these MCAP files in place of the simulator; see "
                  "the parameters of playback")
      ->take_all();
}

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

graph::DeploymentSpec prepare_deployment(const RunOptions& options) {
  auto deployment = graph::load_deployment(find_shipped(options.deploy, "deploy"));
  graph::apply_addresses(deployment, options.addresses);
  graph::apply_wire_settings(deployment, options.wire);
  return deployment;
}

std::vector<std::string> arguments_of(const RunOptions& options) {
  std::vector<std::string> arguments = {"run",
                                        "--graph=" + options.graph,
                                        "--deploy=" + options.deploy,
                                        "--seed=" + std::to_string(options.seed),
                                        "--clock=" + options.clock,
                                        "--threads=" + std::to_string(options.threads),
                                        "--out=" + options.out};
  if (!options.field.empty()) arguments.push_back("--field=" + options.field);
  if (!options.ground.empty()) arguments.push_back("--ground=" + options.ground);
  if (options.length_m) arguments.push_back("--length=" + number(*options.length_m, 6));
  if (!options.record.empty()) arguments.push_back("--record=" + options.record);
  for (const std::string& file : options.recordings) arguments.push_back("--recording=" + file);
  for (const std::string& setting : options.settings) arguments.push_back("--set=" + setting);
  for (const std::string& setting : options.wire) arguments.push_back("--wire=" + setting);
  for (const std::string& address : options.addresses) {
    arguments.push_back("--address=" + address);
  }
  return arguments;
}

void check_out_folder(const std::string& out) {
  const std::filesystem::path path(out);
  if (std::filesystem::exists(path) && !std::filesystem::is_directory(path)) {
    throw ConfigError("--out: " + out + " is not a folder");
  }
}

}  // namespace furrow::cli
