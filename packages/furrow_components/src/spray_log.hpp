#pragma once

#include <optional>
#include <vector>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_core/time.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// Follows the axis through each spray, from the command to open until the last drop leaves. That
/// is a delay after each command, which the calibration tells: there the axis is measured for the
/// spray's event.
class SprayLog {
 public:
  explicit SprayLog(Duration delay) : delay_(delay) {}

  /// `event` as far as it is known; `opened` in it is the command's time.
  void open(furrow_msgs::msg::AxisEvent event, Time opened);
  /// The event of the valve that is open; null when it is shut.
  [[nodiscard]] furrow_msgs::msg::AxisEvent* opened();
  void close(Time closed);
  /// Takes the axis' reading as of `now`. Gives a spray's event once it is complete, stamped when
  /// the last drop leaves.
  [[nodiscard]] std::optional<furrow_msgs::msg::AxisEvent> sample(
      Time now, const actuation::AxisReading& reading);

 private:
  struct Spray {
    furrow_msgs::msg::AxisEvent event;
    Time first_drop;
    std::optional<Time> last_drop;
    bool first_measured = false;
  };

  Duration delay_;
  std::vector<Spray> sprays_;  ///< oldest first
};

}  // namespace furrow::components
