#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_supervisor/resume_policy.hpp"

namespace furrow::supervisor {

/// What a supervisor sees of its processes: reads the diagnostics of all processes of a domain and
/// tells what changes in them. With `resume` it resets what ResumePolicy permits, by axis and
/// cause.
class DeploymentHealth {
 public:
  DeploymentHealth(const dds::DdsParameters& parameters, bool resume);

  /// To be called a few times a second: a line for each status whose level changed since the last
  /// call, at most kMaxLines.
  [[nodiscard]] std::vector<std::string> tick();

 private:
  static constexpr std::size_t kMaxLines = 50;
  static constexpr std::size_t kMaxNames = 10'000;

  void take(const diagnostic_msgs::msg::DiagnosticArray& array);

  void resume_tools();

  const bool resume_;
  std::mutex mutex_;
  std::map<std::string, std::uint8_t> levels_;  // by name; those at 0 are left out
  ResumePolicy policy_;                         // under mutex_
  std::vector<std::string> changes_;
  std::unique_ptr<dds::DdsTransport> transport_;
  std::unique_ptr<graph::TransportWriter> reset_;
  std::unique_ptr<graph::TransportReader> states_;
  std::unique_ptr<graph::TransportReader> reader_;
};

}  // namespace furrow::supervisor
