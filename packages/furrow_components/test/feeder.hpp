#pragma once

#include <memory>

#include "furrow_graph/registry.hpp"

namespace furrow::components {

/// The class of a test's own component "feeder", which publishes the input of the components under
/// test and takes their output. It is constructed from its context and from `world`, which outlives
/// the run.
template <class Feeder, class... World>
[[nodiscard]] graph::ComponentClass feeder_class(World&... world) {
  graph::ComponentClass type{.name = "feeder"};
  Feeder::describe(type.description);
  type.make = [&](graph::Context& context) { return std::make_unique<Feeder>(context, world...); };
  return type;
}

}  // namespace furrow::components
