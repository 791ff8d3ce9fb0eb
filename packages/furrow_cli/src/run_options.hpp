#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "furrow_graph/graph_file.hpp"

namespace furrow::cli {

/// What a run is asked for, whether one process of it or all.
struct RunOptions {
  std::string graph = "weeding";
  std::string deploy = "composed";
  std::vector<std::string> settings;
  std::vector<std::string> wire;
  std::vector<std::string> addresses;
  std::string field;
  std::string ground;
  std::optional<double> length_m;
  std::int64_t seed = 1;
  std::string clock = "real";
  int threads = 2;
  std::string out = "out/run";
  std::string record;                   ///< path of the recording to make
  std::vector<std::string> recordings;  ///< files to play in place of robot and camera

  [[nodiscard]] bool lockstep() const { return clock == "lockstep"; }
};

void add_run_options(CLI::App& command, RunOptions& options);

/// The settings of the graph, those included that have an option of their own. Throws ConfigError.
[[nodiscard]] std::vector<std::string> all_settings(const RunOptions& options);

/// The deployment with the addresses and the wire's parameters of the command line.
[[nodiscard]] graph::DeploymentSpec prepare_deployment(const RunOptions& options);

/// The command line of `furrow run` that asks for the same.
[[nodiscard]] std::vector<std::string> arguments_of(const RunOptions& options);

/// Throws ConfigError when the folder of the report is a file.
void check_out_folder(const std::string& out);

}  // namespace furrow::cli
