#pragma once

namespace furrow::graph {

/// A node of the graph: it takes messages in, calls an algorithm, and publishes what comes back.
///
/// A class `Planner` derives from this and has
///   static void describe(Description& description);  // ports and parameters
///   explicit Planner(Context& context);              // binds them; ConfigError on bad values
///
/// Its callbacks never overlap, so that it needs no mutex, and none is called before every
/// component of the process is constructed or after one is destroyed. The Context outlives it.
class Component {
 public:
  Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;
  virtual ~Component() = default;
};

}  // namespace furrow::graph
