#include "furrow_launch/run_observer.hpp"

#include <atomic>
#include <optional>
#include <utility>

#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::launch {

namespace topics = msgs::topics;

struct RunObserver::State {
  Progress progress;
  RunEnd end = RunEnd::kRecord;
  bool watch_diagnostics = false;
  std::atomic<bool> interrupted = false;
  std::shared_ptr<const furrow_msgs::msg::RunRecord> record;
  std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus> diagnostics;
};

class RunObserver::Observer final : public graph::Component {
 public:
  Observer(graph::Context& context, std::shared_ptr<State> state)
      : context_(context), state_(std::move(state)) {
    context.input<topics::RunStatus>([this](const auto& status) { take(*status); });
    context.input<topics::RunRecord>([this](const auto& record) {
      state_->record = record;
      if (state_->end == RunEnd::kRecord) context_.request_stop("finished");
    });
    if (state_->watch_diagnostics) {
      context.input<topics::Diagnostics>([this](const auto& array) { keep(*array); });
    }
    if (state_->end == RunEnd::kRecord) {
      status_out_.emplace(context.output<topics::RunStatus>());
      context.every(kLook, [this](Time now) {
        if (state_->interrupted) end_early(now);
      });
    }
  }

  static void describe(graph::Description& description, const State& state) {
    description.doc("Reports the progress of the run and takes its record.")
        .input<topics::RunStatus>(graph::Need::kOptional)
        .input<topics::RunRecord>(graph::Need::kOptional);
    if (state.watch_diagnostics) description.input<topics::Diagnostics>(graph::Need::kOptional);
    if (state.end == RunEnd::kRecord) description.output<topics::RunStatus>();
  }

 private:
  static constexpr Duration kLook = Duration::milliseconds(100);
  static constexpr int kLooksForRecord = 10;

  void take(const furrow_msgs::msg::RunStatus& status) {
    last_ = status;
    state_->progress(status);
    if (status.finished() && state_->end == RunEnd::kStatus) context_.request_stop("finished");
  }

  void keep(const diagnostic_msgs::msg::DiagnosticArray& array) {
    constexpr std::size_t kMaxNames = 10'000;
    for (const auto& status : array.status()) {
      if (state_->diagnostics.size() < kMaxNames || state_->diagnostics.contains(status.name())) {
        state_->diagnostics[status.name()] = status;
      }
    }
  }

  void end_early(Time now) {
    if (looks_since_interrupt_ == kLooksForRecord) {
      context_.request_stop("interrupted");
    } else if (looks_since_interrupt_ == 0) {
      last_.finished(true);
      last_.header().stamp(graph::to_msg(now));
      status_out_->publish(last_);
    }
    ++looks_since_interrupt_;
  }

  graph::Context& context_;
  std::shared_ptr<State> state_;
  std::optional<graph::Output<topics::RunStatus>> status_out_;
  furrow_msgs::msg::RunStatus last_;
  int looks_since_interrupt_ = 0;
};

RunObserver::RunObserver(Progress progress, RunEnd end, bool watch_diagnostics)
    : state_(std::make_shared<State>()) {
  state_->progress = std::move(progress);
  state_->end = end;
  state_->watch_diagnostics = watch_diagnostics;
}

void RunObserver::add_to(graph::GraphSpec& graph, graph::Registry& registry) {
  graph::ComponentClass type{.name = "run_observer"};
  Observer::describe(type.description, *state_);
  type.make = [state = state_](graph::Context& context) {
    return std::make_unique<Observer>(context, state);
  };
  registry.add(std::move(type));
  graph.components.push_back({.name = component_name(),
                              .group = component_name(),
                              .class_name = "run_observer",
                              .where = graph.where,
                              .everywhere = true});
}

void RunObserver::interrupt() const {
  state_->interrupted = true;
}

const std::shared_ptr<const furrow_msgs::msg::RunRecord>& RunObserver::record() const {
  return state_->record;
}

const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& RunObserver::diagnostics()
    const {
  return state_->diagnostics;
}

}  // namespace furrow::launch
