#pragma once

#include <memory>

#include "furrow_graph/registry.hpp"

namespace furrow::components {

/// A test's own component "feeder", which gives the components under test what they read and takes
/// what they say: constructed from its context and from `world`, which outlives the run.
template <class Feeder, class... World>
[[nodiscard]] graph::ComponentClass feeder_class(World&... world) {
  graph::ComponentClass type{.name = "feeder"};
  Feeder::describe(type.description);
  type.make = [&](graph::Context& context) { return std::make_unique<Feeder>(context, world...); };
  return type;
}

}  // namespace furrow::components
