#pragma once

#include <functional>
#include <memory>

#include "furrow_graph/graph_file.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::cli {

/// Puts a component into the graph through which the command watches the run: it calls `progress`
/// with each status, and keeps the record. With `stop_on_record` the run ends when the record is
/// there, else when the run says that it is finished.
class RunObserver {
 public:
  using Progress = std::function<void(const furrow_msgs::msg::RunStatus&)>;
  RunObserver(Progress progress, bool stop_on_record);

  void add_to(graph::GraphSpec& graph, graph::Registry& registry);
  [[nodiscard]] static const char* component_name() { return "furrow_run"; }
  /// To be read after the run. Null when there was none.
  [[nodiscard]] const std::shared_ptr<const furrow_msgs::msg::RunRecord>& record() const {
    return state_->record;
  }

 private:
  struct State {
    Progress progress;
    bool stop_on_record = true;
    std::shared_ptr<const furrow_msgs::msg::RunRecord> record;
  };
  std::shared_ptr<State> state_;
};

}  // namespace furrow::cli
