#pragma once

#include <optional>
#include <string>
#include <vector>

#include "furrow_components/georeference.hpp"
#include "furrow_diagnosis/observation.hpp"
#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_launch/external_inputs.hpp"

namespace furrow::diagnosis {

/// An input of the graph from other processes, with its meaning.
struct SensorInput {
  launch::ExternalInput input;
  Role role = Role::kOther;
};

/// How a graph reads the robot's sensors.
struct SensorSetup {
  std::vector<SensorInput> inputs;  ///< in the order of their roles
  Expectation expectation;
  bool rectified = false;  ///< perception's
  components::GeoreferenceParameters georeference;
};

/// From the graph's external inputs, the parameters of its components and the tool's URDF. A depth
/// image that perception does not use is left out. Throws ConfigError.
[[nodiscard]] SensorSetup sensor_setup(const graph::GraphSpec& graph,
                                       const geometry::ToolModel& tool, graph::Registry& registry);

}  // namespace furrow::diagnosis
