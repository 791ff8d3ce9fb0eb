#include "furrow_evaluation/trial_pace.hpp"

#include <algorithm>
#include <optional>

#include "furrow_components/conversions.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::evaluation {

namespace topics = msgs::topics;

struct PaceObserver::State {
  double field_length_m = 0.0;
  std::optional<components::BaseOdometry> first;
  components::BaseOdometry last;
  Pace pace;

  void take(const components::BaseOdometry& base) {
    if (base.X_FB.x_m < 0.0 || base.X_FB.x_m > field_length_m) return;
    if (!first) {
      first = base;
      pace.least_mps = pace.greatest_mps = base.speed_mps;
    }
    last = base;
    pace.least_mps = std::min(pace.least_mps, base.speed_mps);
    pace.greatest_mps = std::max(pace.greatest_mps, base.speed_mps);
  }
};

PaceObserver::PaceObserver(double field_length_m)
    : state_(std::make_shared<State>(State{.field_length_m = field_length_m})) {}

void PaceObserver::add_to(graph::GraphSpec& graph, graph::Registry& registry) {
  graph::ComponentClass type{.name = "pace_observer"};
  type.description.doc("Times the true base over the field.").input<topics::TrueOdometry>();
  type.make = [state = state_](graph::Context& context) {
    context.input<topics::TrueOdometry>(
        [state](const auto& message) { state->take(components::from_msg(*message)); });
    return std::make_unique<graph::Component>();
  };
  registry.add(std::move(type));
  graph.components.push_back({.name = "furrow_pace",
                              .group = "furrow_pace",
                              .class_name = "pace_observer",
                              .where = graph.where,
                              .everywhere = true});
}

Pace PaceObserver::pace() const {
  Pace pace = state_->pace;
  if (state_->first) {
    pace.way_m = state_->last.X_FB.x_m - state_->first->X_FB.x_m;
    pace.time_s = (state_->last.stamp - state_->first->stamp).to_seconds();
  }
  return pace;
}

}  // namespace furrow::evaluation
