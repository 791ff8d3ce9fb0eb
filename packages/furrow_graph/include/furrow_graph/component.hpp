#pragma once

namespace furrow::graph {

/// A node of the graph: it receives messages, calls an algorithm, and publishes the result.
///
/// A class `Planner` derives from this and has
///   static void describe(Description& description);  // ports and parameters
///   explicit Planner(Context& context);              // binds them; ConfigError on bad values
///
/// Its callbacks never overlap, so it needs no mutex. They run only while all components of the
/// process exist. The Context outlives the component.
class Component {
 public:
  Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;
  virtual ~Component() = default;
};

}  // namespace furrow::graph
