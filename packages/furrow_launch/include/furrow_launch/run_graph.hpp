#pragma once

#include "furrow_graph/registry.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/run_options.hpp"

namespace furrow::launch {

/// The graph that the options ask for: with a recorder when the run is to be recorded, and with a
/// recording in place of the simulated robot and camera. Throws ConfigError, also when the
/// recording lacks what a component needs.
[[nodiscard]] PreparedGraph prepare_run(const RunOptions& options, graph::Registry& registry);

}  // namespace furrow::launch
