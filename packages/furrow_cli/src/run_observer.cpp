#include "run_observer.hpp"

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::cli {

namespace topics = msgs::topics;

RunObserver::RunObserver(Progress progress, RunEnd end, bool watch_diagnostics)
    : state_(std::make_shared<State>(State{
          .progress = std::move(progress), .end = end, .watch_diagnostics = watch_diagnostics})) {}

void RunObserver::add_to(graph::GraphSpec& graph, graph::Registry& registry) {
  graph::ComponentClass type{.name = "run_observer"};
  type.description.doc("Shows the progress of the run and takes its record.")
      .input<topics::RunStatus>(graph::Need::kOptional)
      .input<topics::RunRecord>(graph::Need::kOptional);
  if (state_->watch_diagnostics) {
    type.description.input<topics::Diagnostics>(graph::Need::kOptional);
  }
  type.make = [state = state_](graph::Context& context) {
    context.input<topics::RunStatus>([state, &context](const auto& status) {
      state->progress(*status);
      if (status->finished() && state->end == RunEnd::kStatus) context.request_stop("finished");
    });
    context.input<topics::RunRecord>([state, &context](const auto& record) {
      state->record = record;
      if (state->end == RunEnd::kRecord) context.request_stop("finished");
    });
    if (state->watch_diagnostics) {
      context.input<topics::Diagnostics>([state](const auto& array) {
        constexpr std::size_t kMaxNames = 10'000;
        for (const auto& status : array->status()) {
          if (state->diagnostics.size() < kMaxNames || state->diagnostics.contains(status.name())) {
            state->diagnostics[status.name()] = status;
          }
        }
      });
    }
    return std::make_unique<graph::Component>();
  };
  registry.add(std::move(type));
  graph.components.push_back({.name = component_name(),
                              .group = component_name(),
                              .class_name = "run_observer",
                              .where = graph.where,
                              .everywhere = true});
}

}  // namespace furrow::cli
