#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "furrow_graph/graph_file.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::cli {

/// What ends the run in this process.
enum class RunEnd {
  kRecord,  ///< the record is there
  kStatus,  ///< the run says that it is finished
  kNever,   ///< another process
};

/// Puts a component into the graph through which the command watches the run: it calls `progress`
/// with each status, and keeps the record.
class RunObserver {
 public:
  using Progress = std::function<void(const furrow_msgs::msg::RunStatus&)>;
  /// With `watch_diagnostics` it keeps what the processes tell of their health.
  RunObserver(Progress progress, RunEnd end, bool watch_diagnostics = false);

  void add_to(graph::GraphSpec& graph, graph::Registry& registry);
  [[nodiscard]] static const char* component_name() { return "furrow_run"; }
  /// To be read after the run. Null when there was none.
  [[nodiscard]] const std::shared_ptr<const furrow_msgs::msg::RunRecord>& record() const {
    return state_->record;
  }
  /// To be read after the run: the last status of each component and wire, by its name.
  [[nodiscard]] const std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus>& diagnostics()
      const {
    return state_->diagnostics;
  }

 private:
  struct State {
    Progress progress;
    RunEnd end = RunEnd::kRecord;
    bool watch_diagnostics = false;
    std::shared_ptr<const furrow_msgs::msg::RunRecord> record;
    std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus> diagnostics;
  };
  std::shared_ptr<State> state_;
};

}  // namespace furrow::cli
