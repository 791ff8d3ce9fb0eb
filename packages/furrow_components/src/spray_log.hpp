#pragma once

#include <optional>
#include <vector>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_core/time.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// Measures the axis at the first and the last drop of each spray, for the spray's event. Drops
/// leave a calibrated delay after the commands to open and close.
class SprayLog {
 public:
  explicit SprayLog(Duration delay) : delay_(delay) {}

  /// Begins a spray. `opened` is the time of the command, and is set in `event`.
  void open(furrow_msgs::msg::AxisEvent event, Time opened);
  /// The event of the open valve; null when the valve is shut.
  [[nodiscard]] furrow_msgs::msg::AxisEvent* opened();
  void close(Time closed);
  /// Takes the reading of the axis at `now`. Returns the event of a spray once it is complete, with
  /// the stamp of the last drop.
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
