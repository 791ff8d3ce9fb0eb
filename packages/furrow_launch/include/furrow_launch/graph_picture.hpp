#pragma once

#include <span>
#include <string>

#include "furrow_graph/graph_check.hpp"
#include "furrow_graph/graph_file.hpp"

namespace furrow::launch {

/// A graph as SVG: a column for each component, under its process and host; a line for each topic,
/// from a dot at who publishes it to arrowheads at who reads it. Its colour says how far it goes:
/// within a process, between processes, between hosts.
[[nodiscard]] std::string graph_picture(const graph::GraphSpec& graph,
                                        std::span<const graph::Connection> connections,
                                        std::span<const graph::PlacedProcess> processes);

}  // namespace furrow::launch
