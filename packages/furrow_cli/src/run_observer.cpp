#include "run_observer.hpp"

#include "furrow_msgs/topics.hpp"

namespace furrow::cli {

namespace topics = msgs::topics;

RunObserver::RunObserver(Progress progress, bool stop_on_record)
    : state_(std::make_shared<State>(State{std::move(progress), stop_on_record, nullptr})) {}

void RunObserver::add_to(graph::GraphSpec& graph, graph::Registry& registry) {
  graph::ComponentClass type{.name = "run_observer"};
  type.description.doc("Shows the progress of the run and takes its record.")
      .input<topics::RunStatus>(graph::Need::kOptional)
      .input<topics::RunRecord>(graph::Need::kOptional);
  type.make = [state = state_](graph::Context& context) {
    context.input<topics::RunStatus>([state, &context](const auto& status) {
      state->progress(*status);
      if (status->finished() && !state->stop_on_record) context.request_stop("finished");
    });
    context.input<topics::RunRecord>([state, &context](const auto& record) {
      state->record = record;
      if (state->stop_on_record) context.request_stop("finished");
    });
    return std::make_unique<graph::Component>();
  };
  registry.add(std::move(type));
  graph.components.push_back({.name = component_name(),
                              .group = component_name(),
                              .class_name = "run_observer",
                              .where = graph.where});
}

}  // namespace furrow::cli
