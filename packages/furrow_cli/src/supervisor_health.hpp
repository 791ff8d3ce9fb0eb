#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_msgs/diagnostic_msgs.h"

namespace furrow::cli {

/// Reads the diagnostics of all processes of a domain and tells what changes in them.
class SupervisorHealth {
 public:
  explicit SupervisorHealth(const dds::DdsParameters& parameters);

  /// A line for each status whose level changed since the last call, at most kMaxLines.
  [[nodiscard]] std::vector<std::string> take_changes();

 private:
  static constexpr std::size_t kMaxLines = 50;
  static constexpr std::size_t kMaxNames = 10'000;

  void take(const diagnostic_msgs::msg::DiagnosticArray& array);

  std::mutex mutex_;
  std::map<std::string, std::uint8_t> levels_;  // by name; those at 0 are left out
  std::vector<std::string> changes_;
  std::unique_ptr<dds::DdsTransport> transport_;
  std::unique_ptr<graph::WireReader> reader_;
};

}  // namespace furrow::cli
