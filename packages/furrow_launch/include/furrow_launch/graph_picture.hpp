#pragma once

#include <span>
#include <string>

#include "furrow_graph/graph_check.hpp"
#include "furrow_graph/graph_spec.hpp"

namespace furrow::launch {

/// A graph as SVG. Each component is a column, under its process and host. Each topic is a line,
/// from a dot at its publisher to arrowheads at its subscribers. The colour of a line says how far
/// its messages go: within a process, between processes, between hosts.
[[nodiscard]] std::string graph_picture(const graph::GraphSpec& graph,
                                        std::span<const graph::Connection> connections,
                                        std::span<const graph::PlacedProcess> processes);

}  // namespace furrow::launch
