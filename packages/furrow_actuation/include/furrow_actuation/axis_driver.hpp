#pragma once

#include <optional>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation {

/// States by what they mean at the machine.
enum class AxisState {
  kDisabled,       ///< no power at the motor; the axis can be moved by hand
  kHoming,         ///< powered, without its reference or looking for it; takes no positions
  kReady,          ///< powered, homed, standing at its target
  kMoving,         ///< powered, homed, on its way
  kFault,          ///< stopped by itself; stays until reset
  kEmergencyStop,  ///< stopped by an emergency stop; stays until it is released and reset
};
[[nodiscard]] std::string_view to_string(AxisState state);

enum class DriveFault {
  kNone,
  kFollowingError,  ///< too far from the commanded position
  kPositionLimit,   ///< a command or position outside the limits
  kHomingFailed,
  kConnectionLost,
  kDrive,  ///< the drive reports a fault of its own (temperature, current, encoder)
};
[[nodiscard]] std::string_view to_string(DriveFault fault);

/// What the drive last said of itself.
struct AxisReading {
  Time stamp;
  AxisState state = AxisState::kDisabled;
  DriveFault fault = DriveFault::kNone;
  bool homed = false;
  bool powered = true;  ///< the motor may have torque; false only where the drive says so
  double position_m = 0.0;
  double velocity_mps = 0.0;
  double following_error_m = 0.0;  ///< commanded minus measured position
};

/// Powered, homed, and taking setpoints.
[[nodiscard]] inline bool in_service(const AxisReading& reading) {
  return (reading.state == AxisState::kReady || reading.state == AxisState::kMoving) &&
         reading.homed;
}

enum class AxisCommandMode {
  kNone,     ///< nothing new; the axis holds or finishes what it does
  kProfile,  ///< the drive goes to position_m by a profile of its own, within its limits
  kCyclic,   ///< position_m and velocity_mps are the setpoint for the end of this period
  kStop,     ///< the drive stops by itself as fast as its limits allow and stays powered
};

struct AxisCommand {
  AxisCommandMode mode = AxisCommandMode::kNone;
  double position_m = 0.0;
  double velocity_mps = 0.0;
  /// With kCyclic: where the movement ends, for drives that can only go there by themselves.
  std::optional<double> target_m;
};

/// One axis drive, called by a loop: read(), then decide, then write(), each cycle. Requests change
/// the state over the following cycles. No call blocks longer than the driver's own timeout. After
/// an error the reading keeps the last known values, its state kFault.
class AxisDriver {
 public:
  virtual ~AxisDriver() = default;

  /// Fetches the drive's state as of `now`. kUnavailable: no connection.
  [[nodiscard]] virtual Status read(Time now, Duration period) = 0;
  /// Sends a command. kUnavailable: not powered, not homed, in fault, or no connection;
  /// kOutOfRange: a position outside the limits. A refused command moves nothing.
  [[nodiscard]] virtual Status write(Time now, Duration period, const AxisCommand& command) = 0;
  [[nodiscard]] virtual const AxisReading& reading() const = 0;

  /// Power on; from kDisabled. An axis that is homed goes to kReady, else to kHoming,
  /// where it waits for home().
  [[nodiscard]] virtual Status enable(Time now) = 0;
  /// Power off after a stop; from every state.
  [[nodiscard]] virtual Status disable(Time now) = 0;
  /// Looks for the reference; powered axes only.
  [[nodiscard]] virtual Status home(Time now) = 0;
  /// Quick stop: stops with the greatest deceleration and latches kEmergencyStop; from every state.
  /// Connects again where the connection was lost. May be asked again until it is confirmed.
  [[nodiscard]] virtual Status emergency_stop(Time now) = 0;
  /// Out of kFault or kEmergencyStop to kDisabled, when the cause is gone; else kUnavailable.
  [[nodiscard]] virtual Status reset(Time now) = 0;

  /// What of the device's own protections is not confirmed to be in force, for people; empty: all
  /// of it is. Valid until the next call.
  [[nodiscard]] virtual std::string_view unconfirmed() const { return {}; }
};

}  // namespace furrow::actuation
