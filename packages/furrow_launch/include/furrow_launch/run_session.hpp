#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_dds/dds_parameters.hpp"
#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_launch/external_inputs.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/run_observer.hpp"
#include "furrow_launch/run_options.hpp"
#include "furrow_launch/signals.hpp"
#include "furrow_log/log.hpp"

namespace furrow::launch {

/// What one process of a run leaves behind.
struct RunOutcome {
  graph::RunResult result;
  bool interrupted = false;  ///< by a signal; the record, where there is one, ends early
  double wall_s = 0.0;
  std::string process;
  /// Null where another process has it, and where the run ended without one.
  std::shared_ptr<const furrow_msgs::msg::RunRecord> record;
  std::vector<graph::ComponentStatus> components;
  /// The health of the other processes and of the transports, by name; in real time only.
  std::map<std::string, diagnostic_msgs::msg::DiagnosticStatus> diagnostics;
};

/// One process of a run, from its options to its outcome.
class RunSession {
 public:
  struct Callbacks {
    RunObserver::Progress progress;                ///< see RunObserver
    std::function<void(const std::string&)> warn;  ///< one sentence for the user
    log::Log* log = nullptr;                       ///< of the components; null: none
  };

  /// Prepares and checks the graph and picks the process. `process` may be empty where the
  /// deployment has only one; `use_dds` false keeps a single process out of the DDS domain. Throws
  /// ConfigError.
  RunSession(const RunOptions& options, const std::string& process, bool use_dds);

  /// Whether the outcome of this process will hold the record of the run.
  [[nodiscard]] bool reports() const { return end_ == RunEnd::kRecord; }
  /// Whether the progress of the run is this process's to show.
  [[nodiscard]] bool shows_progress() const { return placed_.size() == 1 || reports(); }
  [[nodiscard]] const PreparedGraph& prepared() const { return prepared_; }
  /// The name of this process; empty where the deployment has only one.
  [[nodiscard]] std::string process_name() const {
    return placed_.size() > 1 ? process_.name : std::string();
  }

  /// Runs until the run is finished, or until a signal. The first signal asks for an end with the
  /// record of what was done so far; a second one, or five seconds, end the run as it is. To be
  /// called once. Throws ConfigError, and std::runtime_error when the transport cannot start.
  [[nodiscard]] RunOutcome run(SignalPipe& signals, const Callbacks& callbacks);

 private:
  /// Throws ConfigError where inputs can come from no driver and no recording.
  void check_external_inputs();
  [[nodiscard]] std::vector<ExternalInput> inputs_of_process();
  [[nodiscard]] dds::DdsParameters dds_parameters() const;
  [[nodiscard]] graph::RuntimeOptions runtime_options() const;

  RunOptions options_;
  bool use_dds_;
  graph::Registry registry_;
  PreparedGraph prepared_;
  configuration::DeploymentSpec deployment_;
  std::vector<graph::PlacedProcess> placed_;
  graph::PlacedProcess process_;
  RunEnd end_ = RunEnd::kRecord;
};

}  // namespace furrow::launch
