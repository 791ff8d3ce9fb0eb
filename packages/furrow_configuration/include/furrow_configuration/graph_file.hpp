#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_graph/graph_spec.hpp"

namespace furrow::configuration {

/// Reads a graph file:
///
///   graph: weeding
///   common: {tool_file: ../urdf/bonnbot.urdf}   # for every component that declares the parameter
///   external: [emergency_stop]                   # topics that come from outside the graph
///   components:
///     tracker:
///       class: tracker
///       parameters_file: ../components/tracker.yaml
///       parameters: {confirm_views: 2}           # over those of the file
///       remap: {perception/instances: truth/instances}
///     axis:
///       class: axis_driver
///       thread: dedicated       # in real time: not called by the thread pool
///       priority: 60            # SCHED_FIFO and locked memory, where permitted
///       for_each: axes          # one component "axis_NAME" for each NAME of the list
///       parameter: axis         # which parameter takes NAME
/// `for_each` entries stay until expand_lists(). Throws ConfigError with file, line and key.
[[nodiscard]] graph::GraphSpec load_graph(const std::filesystem::path& path);

/// The value of a common parameter, or empty.
[[nodiscard]] std::string common_text(const graph::GraphSpec& graph, std::string_view name);

/// Replaces each `for_each` entry by one component per name of its list.
void expand_lists(graph::GraphSpec& graph,
                  const std::map<std::string, std::vector<std::string>>& lists);

/// Overrides parameters with "COMPONENT.KEY=VALUE", or "common.KEY=VALUE" for common ones. Throws
/// ConfigError if no component has that name.
void apply_settings(graph::GraphSpec& graph, const std::vector<std::string>& settings);

}  // namespace furrow::configuration
