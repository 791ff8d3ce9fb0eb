#pragma once

#include <functional>

#include "furrow_actuation/axis_controller.hpp"
#include "furrow_actuation/drive_supervisor.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation {

/// What of the safe state the devices themselves have confirmed.
struct StopConfirmation {
  bool valve_shut = false;
  bool power_off = false;
  [[nodiscard]] bool complete() const { return valve_shut && power_off; }
};

/// The outcome of one cycle.
struct CycleReport {
  ControllerOutput output;
  Time valve_written;  ///< when the valve's level had been written
  bool read_ok = true;
  bool valve_ok = true;
  bool write_ok = true;
};

/// The control loop of one tool: its controller with drive and valve. In each cycle the valve is
/// written before the drive. Where a cause for the safe state is known already, the valve is shut
/// before the drive is read. Called from one thread.
class ToolLoop {
 public:
  /// The devices outlive it. `clock` gives the time of the cycles' clock now, for stamps of writes.
  /// Throws ConfigError when the loop's deadline is not longer than two periods.
  ToolLoop(AxisController& controller, AxisDriver& driver, ValveDriver& valve, Duration period,
           double loop_deadline_s, std::function<Time()> clock);

  /// As ToolSafety::request_reset. Resetting all causes also tries again to bring a drive into
  /// service that did not get there at the start.
  void request_reset(Time now, SafetyCause cause);
  /// @pre `now` does not decrease.
  [[nodiscard]] const CycleReport& cycle(Time now);
  /// Shuts the valve, stops the drive and removes its power, whatever the mode, until both are
  /// confirmed or `at_most_s` of real time have passed. To be called before the end of the process.
  StopConfirmation shut_down(Time now, double at_most_s);

  [[nodiscard]] const DriveSupervisor& supervisor() const { return supervisor_; }

 private:
  void write_valve(Time now, bool open);
  void serve_drive(Time now);

  AxisController& controller_;
  AxisDriver& driver_;
  ValveDriver& valve_;
  Duration period_;
  std::function<Time()> clock_;
  DriveSupervisor supervisor_;
  CycleReport report_;
  bool valve_open_ = false;  ///< as written last
};

}  // namespace furrow::actuation
