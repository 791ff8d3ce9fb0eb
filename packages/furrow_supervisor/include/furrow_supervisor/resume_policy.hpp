#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::supervisor {

/// Which latched causes `--resume` resets: those of a lost peer, by axis and cause, and no other.
/// The tool itself refuses the reset of a cause that has not cleared.
class ResumePolicy {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kBetweenResets{1};

  /// The newest state of an axis.
  void take(const furrow_msgs::msg::AxisState& state);
  /// The resets to be published now: at most one a second for each axis and cause.
  [[nodiscard]] std::vector<furrow_msgs::msg::ToolReset> due(Clock::time_point now);

 private:
  static constexpr std::size_t kMostAxes = 1'000;
  struct Axis {
    std::vector<msgs::SafetyCause> lost;
    std::optional<Clock::time_point> last_reset;
  };
  std::map<std::string, Axis> axes_;
};

}  // namespace furrow::supervisor
