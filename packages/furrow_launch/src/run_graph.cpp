#include "furrow_launch/run_graph.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "furrow_configuration/graph_file.hpp"
#include "furrow_core/text.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_log/level.hpp"
#include "furrow_recording/player.hpp"

namespace furrow::launch {
namespace {

constexpr char kRecorder[] = "recorder";
constexpr char kPlayback[] = "playback";
constexpr char kSprays[] = "sprays";

graph::ComponentSpec component(const graph::GraphSpec& graph, const std::string& name,
                               const std::string& class_name) {
  graph::ComponentSpec spec;
  spec.name = name;
  spec.group = name;
  spec.class_name = class_name;
  spec.where = graph.where;
  return spec;
}

void add_recorder(graph::GraphSpec& graph, const RunOptions& options) {
  graph::ComponentSpec recorder = component(graph, kRecorder, "recorder");
  const SourceLocation where{"--record", 0};
  const auto file = std::filesystem::absolute(options.record).string();
  recorder.parameters = {{"file", file, where}, {"wait_for_disk", options.lockstep(), where}};
  graph.components.push_back(std::move(recorder));
}

/// Where the valves of the simulated robot spray is simulated beside the recording too.
graph::ComponentSpec sprays_of(const graph::GraphSpec& graph, const graph::ComponentSpec& robot) {
  graph::ComponentSpec sprays = component(graph, kSprays, "spray_simulator");
  for (const GivenParameter& parameter : robot.parameters) {
    if (parameter.name == "rate_hz" || parameter.name == "tool_file" ||
        parameter.name.starts_with("spray_")) {
      sprays.parameters.push_back(parameter);
    }
  }
  return sprays;
}

/// Leaves out the common parameters that only the simulators had.
void drop_unused_common(graph::GraphSpec& graph, graph::Registry& registry) {
  std::erase_if(graph.common, [&](const GivenParameter& common) {
    return std::ranges::none_of(graph.components, [&](const graph::ComponentSpec& spec) {
      const auto& declared =
          registry.find(spec.class_name, spec.where).description.declared_parameters_list();
      return std::ranges::any_of(declared, [&](const DeclaredParameter& parameter) {
        return parameter.info.name == common.name;
      });
    });
  });
}

void replace_world(graph::GraphSpec& graph, graph::Registry& registry, const RunOptions& options) {
  (void)graph::check_graph(graph, registry);  // what is wrong with it is told of the whole
  graph::ComponentSpec playback = component(graph, kPlayback, "playback");
  const SourceLocation where{"--recording", 0};
  std::vector<std::string> files;
  for (const std::string& file : options.recordings) {
    files.push_back(std::filesystem::absolute(file).string());
  }
  playback.parameters = {{"files", files, where}};
  // As real sensors, it is late for no component that computes.
  playback.dedicated_thread = true;
  std::vector<graph::ComponentSpec> kept = {std::move(playback)};
  for (graph::ComponentSpec& spec : graph.components) {
    if (spec.class_name == "robot_simulator") {
      kept.push_back(sprays_of(graph, spec));
    } else if (spec.class_name != "camera_simulator") {
      kept.push_back(std::move(spec));
    }
  }
  graph.components = std::move(kept);
  drop_unused_common(graph, registry);
}

/// What is played, by its names in the graph.
std::set<std::string> played_topics(const graph::GraphSpec& graph) {
  const auto playback = std::ranges::find(graph.components, kPlayback, &graph::ComponentSpec::name);
  std::vector<std::filesystem::path> files;
  recording::PlayerOptions options;
  for (const GivenParameter& parameter : playback->parameters) {
    const auto* list = std::get_if<std::vector<std::string>>(&parameter.value);
    if (list == nullptr) continue;
    if (parameter.name == "files") files.assign(list->begin(), list->end());
    if (parameter.name == "include") options.topics.include = *list;
    if (parameter.name == "exclude") options.topics.exclude = *list;
    if (parameter.name != "remap") continue;
    for (const std::string& remap : *list) {
      const auto equals = remap.find('=');
      if (equals != std::string::npos) {
        options.remap[remap.substr(0, equals)] = remap.substr(equals + 1);
      }
    }
  }
  const auto player = recording::Player::open(files, options);
  if (!player) throw ConfigError("--recording: " + player.error().message);
  std::set<std::string> names;
  for (const auto& topic : player->topics()) names.insert(topic.name);
  return names;
}

void check_recording(const graph::GraphSpec& graph, graph::Registry& registry) {
  const std::set<std::string> played = played_topics(graph);
  const auto connections = graph::check_graph(graph, registry);
  for (const graph::ComponentSpec& spec : graph.components) {
    const auto& type = registry.find(spec.class_name, spec.where);
    for (const graph::PortInfo& port : type.description.inputs()) {
      if (port.need != graph::Need::kRequired) continue;
      const std::string topic = graph::resolved_topic(spec, *port.topic);
      const auto from = std::ranges::find(connections, topic, &graph::Connection::topic);
      const bool only_played = from != connections.end() && from->publishers.size() == 1 &&
                               from->publishers.front() == kPlayback;
      if (!only_played || played.contains(topic)) continue;
      throw ConfigError("--recording: has no '" + topic + "', which " + spec.name + " needs");
    }
  }
}

/// Throws ConfigError for a malformed level, and for one of a component that does not exist.
void check_log_levels(const graph::GraphSpec& graph, const std::vector<std::string>& settings) {
  log::Levels levels;
  for (const std::string& setting : settings) levels.set(setting);
  std::vector<std::string> writers = {"furrow",  "supervisor", "transport",
                                      "fastdds", "opencv",     "log"};
  for (const auto& component : graph.components) writers.push_back(component.name);
  for (const std::string& name : levels.components()) {
    if (std::ranges::find(writers, name) != writers.end()) continue;
    throw ConfigError("--log-level " + name + ": no component '" + name + "' in graph '" +
                      graph.name + "', nor a library" + did_you_mean(name, writers));
  }
}

}  // namespace

PreparedGraph prepare_run(const RunOptions& options, graph::Registry& registry) {
  std::vector<std::string> settings;
  std::vector<std::string> of_recordings;
  for (const std::string& setting : all_settings(options)) {
    const bool later = (!options.record.empty() && setting.starts_with("recorder.")) ||
                       (!options.recordings.empty() &&
                        (setting.starts_with("playback.") || setting.starts_with("sprays.")));
    (later ? of_recordings : settings).push_back(setting);
  }
  PreparedGraph prepared = prepare_graph(options.graph, settings);
  if (!options.recordings.empty()) replace_world(prepared.spec, registry, options);
  if (!options.record.empty()) add_recorder(prepared.spec, options);
  configuration::apply_settings(prepared.spec, of_recordings);
  if (!options.recordings.empty()) check_recording(prepared.spec, registry);
  check_log_levels(prepared.spec, options.log_levels);
  return prepared;
}

}  // namespace furrow::launch
