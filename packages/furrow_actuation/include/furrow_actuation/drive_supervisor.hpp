#pragma once

#include <string>

#include "furrow_actuation/axis_driver.hpp"

namespace furrow::actuation {

/// Brings a drive into service and takes it out. It powers and homes the drive at the start, and
/// after reset(). A drive that was in service and fell out of it is left alone until reset().
/// Before it was in service for the first time, a drive that does not answer is tried again.
class DriveSupervisor {
 public:
  /// One cycle, between the driver's read() and write(): asks at most one thing of the driver.
  void update(Time now, AxisDriver& driver);
  /// Out of fault or emergency stop and into service again, once the cause is gone; given up after
  /// kPatience.
  void reset(Time now);
  /// From now on, asked each cycle until the drive confirms it: quick stop, and power off once the
  /// axis stands. Stays so until reset().
  void take_out();

  /// True while it works towards the drive being in service.
  [[nodiscard]] bool busy() const { return wanted_; }
  [[nodiscard]] bool taken_out() const { return out_; }
  /// The drive itself says, in its newest reading, that it has no power.
  [[nodiscard]] bool power_off_confirmed() const { return power_off_confirmed_; }
  /// What the driver last refused, or empty.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

  static constexpr Duration kRetry = Duration::milliseconds(100);
  static constexpr Duration kPatience = Duration::milliseconds(5000);

 private:
  void ask(Time now, const Status& answer);
  void continue_out(Time now, AxisDriver& driver);
  void bring_in(Time now, AxisDriver& driver);

  bool out_ = false;
  bool power_off_confirmed_ = false;
  bool wanted_ = true;
  bool was_in_service_ = false;
  bool reset_requested_ = false;
  bool homing_requested_ = false;
  Time reset_deadline_;
  Time next_try_;
  std::string refusal_;
};

}  // namespace furrow::actuation
