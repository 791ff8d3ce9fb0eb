#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_dds/dds_parameters.hpp"
#include "furrow_launch/run_options.hpp"
#include "furrow_log/log.hpp"
#include "furrow_supervisor/supervisor.hpp"

namespace furrow::supervisor {

/// The processes of a deployment that live on one host, each a `furrow run --process`.
class SupervisedDeployment {
 public:
  /// Checks the graph and the deployment. `host` may be empty where the deployment names no hosts.
  /// Throws ConfigError.
  SupervisedDeployment(launch::RunOptions options, const std::string& host);

  /// Whether a process of this host writes the report of the run.
  [[nodiscard]] bool reports() const;

  struct RunParameters {
    std::filesystem::path program;  ///< that is started as `PROGRAM run ...`
    std::filesystem::path out;      ///< folder of the report; claimed by the caller
    /// Lets tools that lost a peer leave their safe state once the peer is back.
    bool resume = false;
    std::function<void(const std::string& line)> show;  ///< a line for the user
  };
  /// Runs the processes until the run ends; the exit code for the user. To be called once. Throws
  /// std::runtime_error when the transport cannot start.
  [[nodiscard]] int run(const RunParameters& parameters) const;

 private:
  struct Process {
    std::string name;
    bool restart = true;
    bool reports = false;
  };
  /// Opens the supervisor's log and removes the logs of earlier runs. Throws ConfigError.
  void open_logs(const std::filesystem::path& out, log::Log& own) const;
  [[nodiscard]] std::vector<SupervisedProcess> commands(const RunParameters& parameters) const;

  launch::RunOptions options_;
  configuration::DeploymentSpec deployment_;
  std::string host_;
  dds::DdsParameters dds_;
  std::vector<std::string> drivers_without_latches_;
  std::vector<Process> processes_;
};

}  // namespace furrow::supervisor
