#pragma once

#include <optional>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_actuation/motion_profile.hpp"
#include "furrow_core/parameters.hpp"

namespace furrow::actuation {

struct SimulatedAxisParameters {
  double lag_s = 0.0;
  double following_error_limit_m = 0.05;
  double homing_speed_mps = 0.5;
  double homing_timeout_s = 10.0;
  double start_position_m = 0.0;
  bool start_ready = false;
  double watchdog_s = 0.0;

  void visit(ParameterVisitor& v);
};

/// A simulated servo drive. The axis follows its setpoint as a first-order lag (0: ideally), so the
/// following error is velocity times lag and limits kept by the setpoint are kept by the axis.
/// On a fault, an emergency stop, a cut wire or when setpoints stop coming it brakes by itself with
/// the greatest deceleration, without regard to the jerk. Time moves in read(): the axis is
/// simulated up to `now`. With a watchdog, a drive that is not called for longer makes a quick
/// stop, removes its power once it stands, and reports a fault.
class SimulatedAxisDriver final : public AxisDriver {
 public:
  /// Throws ConfigError for limits that are not positive or a start outside them.
  SimulatedAxisDriver(const MotionLimits& limits, const SimulatedAxisParameters& parameters);

  [[nodiscard]] Status read(Time now, Duration period) override;
  [[nodiscard]] Status write(Time now, Duration period, const AxisCommand& command) override;
  [[nodiscard]] const AxisReading& reading() const override { return reading_; }
  [[nodiscard]] Status enable(Time now) override;
  [[nodiscard]] Status disable(Time now) override;
  [[nodiscard]] Status home(Time now) override;
  [[nodiscard]] Status emergency_stop(Time now) override;
  [[nodiscard]] Status reset(Time now) override;

  /// Moves time as read() does, without a call of the drive.
  void advance(Time now) { simulate_to(now); }
  /// A fault of the drive: stops, latches kFault. The cause lasts until clear_faults().
  void inject(Time now, DriveFault fault);
  /// The axis is jammed: it stands where it is, whatever the setpoint.
  void set_jammed(bool jammed) { jammed_ = jammed; }
  /// The connection is cut: calls fail with kUnavailable; the drive stops by itself.
  void set_connected(Time now, bool connected);
  /// The reference switch is missing: homing times out.
  void set_reference_missing(bool missing) { reference_missing_ = missing; }
  /// Takes away the cause of an injected fault, so that reset() succeeds.
  void clear_faults() { cause_lasts_ = false; }

 private:
  enum class Setpoint { kHold, kProfile, kCyclic, kHoming };

  [[nodiscard]] MotionState setpoint_at(Time time) const;
  void simulate_to(Time now);
  void simulate_step(Time next);
  void follow_setpoint(const MotionState& from, double h);
  void watch_contact(Time next);
  void stop_from(Time now);
  void fail(Time now, DriveFault fault);
  [[nodiscard]] Status start_cyclic(Time now, Duration period, const AxisCommand& command);
  [[nodiscard]] Status refuse_unless_connected() const;

  MotionLimits limits_;
  SimulatedAxisParameters parameters_;
  AxisReading reading_;
  Setpoint mode_ = Setpoint::kHold;
  MotionProfile profile_;
  Time profile_start_;
  MotionState cyclic_from_;
  MotionState cyclic_to_;
  Time cyclic_start_;
  Time cyclic_end_;
  MotionState setpoint_;
  Time simulated_to_;
  Time homing_deadline_;
  std::optional<Time> last_contact_;
  bool started_ = false;
  bool powered_ = false;
  bool jammed_ = false;
  bool connected_ = true;
  bool reference_missing_ = false;
  bool cause_lasts_ = false;
};

}  // namespace furrow::actuation
