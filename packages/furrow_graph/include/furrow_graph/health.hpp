#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace furrow::graph {

/// Levels of diagnostic_msgs/DiagnosticStatus.
enum class HealthLevel : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

/// The health of one component: its level, the reason, and its counters.
struct Health {
  HealthLevel level = HealthLevel::kOk;
  std::string message;
  std::map<std::string, std::int64_t> counters;
};

}  // namespace furrow::graph
