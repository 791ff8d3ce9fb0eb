#pragma once

#include <memory>

#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/registry.hpp"

namespace furrow::evaluation {

/// How fast the base truly crossed a field.
struct Pace {
  double way_m = 0.0;  ///< along the row
  double time_s = 0.0;
  double least_mps = 0.0;
  double greatest_mps = 0.0;
};

/// Puts a component into the graph that times the true base from the field's start to its end,
/// without the way in and out.
class PaceObserver {
 public:
  explicit PaceObserver(double field_length_m);

  void add_to(graph::GraphSpec& graph, graph::Registry& registry);
  /// To be read after the run. No way when the field was not reached.
  [[nodiscard]] Pace pace() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace furrow::evaluation
