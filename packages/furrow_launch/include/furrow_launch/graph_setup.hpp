#pragma once

#include <string>
#include <vector>

#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/graph_spec.hpp"

namespace furrow::launch {

/// A graph as the command line asks for it: its file, expanded over the axes of its tool and merged
/// with the settings.
struct PreparedGraph {
  graph::GraphSpec spec;
  geometry::ToolModel tool;       ///< empty where the graph has none
  std::vector<std::string> axes;  ///< names, in the order of the tool model
};

/// `settings` are "COMPONENT.KEY=VALUE". Throws ConfigError.
[[nodiscard]] PreparedGraph prepare_graph(const std::string& graph,
                                          const std::vector<std::string>& settings);

}  // namespace furrow::launch
