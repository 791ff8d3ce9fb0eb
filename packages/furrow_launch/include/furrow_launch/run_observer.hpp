#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::launch {

/// What ends the run in this process.
enum class RunEnd {
  kRecord,  ///< the record of the run arrives
  kStatus,  ///< the run's status says that it is finished
  kNever,   ///< another process ends it
};

/// A component that the command adds to a graph to watch the run: it reports each status, and keeps
/// the record.
class RunObserver {
 public:
  using Progress = std::function<void(const furrow_msgs::msg::RunStatus&)>;
  /// `progress` is called from the graph's threads, one call at a time. With `watch_diagnostics`
  /// the observer keeps the health that the processes report.
  RunObserver(Progress progress, RunEnd end, bool watch_diagnostics = false);

  /// Call after the graph was checked: the observer publishes `run/status` when it is interrupted,
  /// so a graph without a status of its own would pass the check.
  void add_to(graph::GraphSpec& graph, graph::Registry& registry);
  [[nodiscard]] static const char* component_name() { return "furrow_run"; }

  /// Asks a run that waits for its record (RunEnd::kRecord) to end early, from any thread. The
  /// observer publishes that the run is finished, so that the scorer publishes the record of what
  /// was done so far. Without an answer within a second of the graph's clock the run ends without.
  void interrupt() const;

  /// After the run. Null when there was none.
  [[nodiscard]] const std::shared_ptr<const furrow_msgs::msg::RunRecord>& record() const;
  /// After the run: the last status of each component and transport, by its name.
  [[nodiscard]] const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics()
      const;

 private:
  struct State;
  class Observer;
  std::shared_ptr<State> state_;
};

}  // namespace furrow::launch
