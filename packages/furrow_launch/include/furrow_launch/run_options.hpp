#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "furrow_configuration/deployment_file.hpp"

namespace furrow::launch {

/// What a user asks of a run, whether of one process of it or of all.
struct RunOptions {
  std::string graph = "weeding";          ///< a file, or the name of a shipped one
  std::string deploy = "composed";        ///< likewise
  std::vector<std::string> settings;      ///< "COMPONENT.KEY=VALUE"
  std::optional<std::int64_t> domain_id;  ///< nothing: the deployment's, else ROS_DOMAIN_ID
  std::vector<std::string> dds_settings;  ///< "KEY=VALUE" of dds::DdsParameters
  std::vector<std::string> addresses;     ///< "HOST=ADDRESS"
  std::string field;                      ///< preset, CSV or GeoJSON; empty: the graph's
  std::string ground;                     ///< "rendered", "photos:FOLDER", or empty
  std::optional<double> length_m;
  std::int64_t seed = 1;
  std::string clock = "real";  ///< or "lockstep"
  int threads = 2;
  std::string out = "out/run";          ///< folder of the report
  std::string record;                   ///< path of the recording to make; empty: none
  std::vector<std::string> recordings;  ///< files to play in place of robot and camera
  std::vector<std::string> log_levels;  ///< "LEVEL" or "COMPONENT=LEVEL"

  [[nodiscard]] bool lockstep() const { return clock == "lockstep"; }
};

/// The settings of the graph, with those of --field, --length and --ground before them. Throws
/// ConfigError.
[[nodiscard]] std::vector<std::string> all_settings(const RunOptions& options);

/// The deployment with the addresses, the domain and the DDS settings of the options. Throws
/// ConfigError.
[[nodiscard]] configuration::DeploymentSpec prepare_deployment(const RunOptions& options);

/// Arguments of `furrow` that run a process with the same options.
[[nodiscard]] std::vector<std::string> run_arguments(const RunOptions& options);

/// The log in the folder of the report: run.log, or run_PROCESS.log where `process` is not empty.
[[nodiscard]] std::filesystem::path log_file(const std::filesystem::path& folder,
                                             const std::string& process);

}  // namespace furrow::launch
