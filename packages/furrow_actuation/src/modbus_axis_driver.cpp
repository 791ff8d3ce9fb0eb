#include "furrow_actuation/modbus_axis_driver.hpp"

#include <array>
#include <cmath>

#include "cia402_objects.hpp"
#include "furrow_core/error.hpp"
#include "gateway_connection.hpp"

namespace furrow::actuation::cia402 {
namespace {

using namespace objects;

constexpr double kStanding_mps = 1e-3;

Error unavailable(std::string why) {
  return {ErrorCode::kUnavailable, std::move(why)};
}

void require_fits(double units, double greatest, const char* what) {
  if (std::isfinite(units) && std::abs(units) <= greatest) return;
  throw ConfigError(std::string("Modbus axis: ") + what + " does not fit into the drive's units");
}

}  // namespace

ModbusAxisDriver::ModbusAxisDriver(const MotionLimits& limits,
                                   const ModbusAxisParameters& parameters)
    : limits_(limits), parameters_(parameters) {
  if (!plan_s_curve(limits, {limits.lower_m, 0.0, 0.0}, limits.lower_m).ok()) {
    throw ConfigError("Modbus axis: the limits are not positive or not ordered");
  }
  if (!(parameters.counts_per_m > 0.0)) {
    throw ConfigError("Modbus axis: counts_per_m must be positive");
  }
  // Every number that is sent to the drive as a multiple of its units is 32 bits wide.
  constexpr double kGreatest = 2147483647.0;
  const auto require_counts = [&](double value, const char* what) {
    require_fits(value * parameters.counts_per_m, kGreatest, what);
  };
  require_counts(limits.lower_m, "the lower limit of the URDF times counts_per_m");
  require_counts(limits.upper_m, "the upper limit of the URDF times counts_per_m");
  require_counts(limits.max_velocity_mps, "the velocity limit of the URDF times counts_per_m");
  require_counts(limits.max_acceleration_mps2,
                 "the acceleration limit of the URDF times counts_per_m");
  require_counts(parameters.homing_speed_mps, "homing_speed_mps times counts_per_m");
  require_counts(parameters.homing_acceleration_mps2,
                 "homing_acceleration_mps2 times counts_per_m");
  if (parameters.watchdog_index != 0) {
    const double greatest =
        std::ldexp(1.0, static_cast<int>(8 * parameters.watchdog_bytes - 1)) - 1.0;
    require_fits(parameters.watchdog_s / parameters.watchdog_unit_s, greatest,
                 "watchdog_s in units of watchdog_unit_s");
  }
}

// A drive that is left powered would hold, or go on to, its last target.
ModbusAxisDriver::~ModbusAxisDriver() {
  if (!connection_ || !reading_.powered) return;
  start_budget();
  (void)set(kControlword, command::kQuickStop).ok();
}

void ModbusAxisDriver::start_budget(double timeouts) {
  budget_.emplace(timeouts * parameters_.timeout_s);
}

std::int32_t ModbusAxisDriver::counts(double meters) const {
  return static_cast<std::int32_t>(std::lround(meters * parameters_.counts_per_m));
}

bool ModbusAxisDriver::operating() const {
  return decode_state(statusword_) == State::kOperationEnabled;
}

void ModbusAxisDriver::lose_connection() {
  connection_.reset();
  lost_ = true;
  homing_ = false;
  reading_.homed = false;
  reading_.state = AxisState::kFault;
  reading_.fault = DriveFault::kConnectionLost;
  reading_.powered = true;  // for all that is known
  if (!emergency_stop_) sequencer_.set_goal(Goal::kPowerOff);
}

Result<std::int32_t> ModbusAxisDriver::get(const Object& object) {
  return exchange(read_request(object), object, false);
}

Status ModbusAxisDriver::set(const Object& object, std::int32_t value) {
  const auto answer = exchange(write_request(object, value), object, true);
  if (!answer) return answer.error();
  return {};
}

Result<std::int32_t> ModbusAxisDriver::exchange(const Telegram& request, const Object& object,
                                                bool write) {
  if (!connection_) return unavailable("no connection to the drive");
  auto value = connection_->exchange(request, object, write, *budget_);
  if (value.ok() || value.error().code == ErrorCode::kUnavailable) return value;
  lose_connection();
  if (value.error().code == ErrorCode::kIo) return unavailable(value.error().message);
  return value;
}

Status ModbusAxisDriver::send_controlword(std::uint16_t word) {
  if (Status status = set(kControlword, word); !status) return status;
  controlword_ = word;
  profile_target_.reset();
  return {};
}

Status ModbusAxisDriver::ensure_mode(Mode mode) {
  const auto wanted = static_cast<std::int32_t>(mode);
  if (mode_ == wanted) return {};
  if (Status status = set(kModeOfOperation, wanted); !status) return status;
  mode_ = wanted;
  profile_target_.reset();
  return {};
}

Status ModbusAxisDriver::move_by_profile(double position_m) {
  const std::int32_t target = counts(position_m);
  if (Status status = ensure_mode(Mode::kProfilePosition); !status) return status;
  if (profile_target_ == target) return {};
  // A new set-point is taken on the rising edge of its bit.
  constexpr std::uint16_t kBase = command::kEnableOperation | command::kChangeImmediately;
  Status status = set(kTargetPosition, target);
  if (status.ok()) status = send_controlword(kBase);
  if (status.ok()) status = send_controlword(kBase | command::kNewSetpoint);
  if (status.ok()) profile_target_ = target;
  return status;
}

Status ModbusAxisDriver::read(Time now, Duration) {
  if (!connection_) {
    if (lost_) return unavailable("the connection to the drive was lost");
    if (Status status = connect(); !status) return status;
  }
  start_budget();
  if (Status status = read_objects(); !status) return status;
  interpret(now);
  return {};
}

Status ModbusAxisDriver::read_objects() {
  const auto statusword = get(kStatusword);
  if (!statusword) return statusword.error();
  const auto position = get(kPosition);
  if (!position) return position.error();
  const auto velocity = get(kVelocity);
  if (!velocity) return velocity.error();
  if (parameters_.has_following_error) {
    const auto error = get(kFollowingErrorValue);
    if (!error) return error.error();
    reading_.following_error_m = *error / parameters_.counts_per_m;
  }
  statusword_ = static_cast<std::uint16_t>(*statusword);
  reading_.position_m = *position / parameters_.counts_per_m;
  reading_.velocity_mps = *velocity / parameters_.counts_per_m;
  return {};
}

void ModbusAxisDriver::interpret(Time now) {
  reading_.stamp = now;
  const auto state = decode_state(statusword_);
  reading_.powered = !state || *state == State::kOperationEnabled ||
                     *state == State::kQuickStopActive || *state == State::kFaultReactionActive;
  if (state == State::kFault || state == State::kFaultReactionActive) {
    homing_ = false;
    const bool following = (statusword_ & status_bit::kFollowingError) != 0;
    reading_.fault = following ? DriveFault::kFollowingError : DriveFault::kDrive;
  } else if (!homing_failed_ && !lost_) {
    reading_.fault = DriveFault::kNone;
  }
  if (homing_ && state) interpret_homing(*state);
  if (state != State::kOperationEnabled) homing_ = false;
  if (power_off_when_standing_ && std::abs(reading_.velocity_mps) < kStanding_mps) {
    power_off_when_standing_ = false;
    sequencer_.set_goal(Goal::kPowerOff);
  }
  reading_.state = axis_state(state);
}

void ModbusAxisDriver::interpret_homing(State state) {
  if (state != State::kOperationEnabled) return;
  if ((statusword_ & status_bit::kHomingError) != 0) {
    homing_ = false;
    homing_failed_ = true;
    reading_.fault = DriveFault::kHomingFailed;
    sequencer_.set_goal(Goal::kPowerOff);
  } else if ((statusword_ & status_bit::kHomingAttained) != 0 &&
             (statusword_ & status_bit::kTargetReached) != 0) {
    homing_ = false;
    reading_.homed = true;
  }
}

AxisState ModbusAxisDriver::axis_state(std::optional<State> state) const {
  if (emergency_stop_) return AxisState::kEmergencyStop;
  const bool faulted = state == State::kFault || state == State::kFaultReactionActive;
  if (lost_ || faulted || homing_failed_) return AxisState::kFault;
  if (state != State::kOperationEnabled) return AxisState::kDisabled;
  if (!reading_.homed) return AxisState::kHoming;
  const bool moving = (statusword_ & status_bit::kTargetReached) == 0;
  return moving ? AxisState::kMoving : AxisState::kReady;
}

Status ModbusAxisDriver::write(Time, Duration, const AxisCommand& command) {
  if (!connection_) return unavailable("no connection to the drive");
  start_budget();
  const std::uint16_t wanted = sequencer_.next(statusword_);
  if (sequencer_.goal() == Goal::kResetFault && sequencer_.reached(statusword_)) {
    sequencer_.set_goal(Goal::kPowerOff);
  }
  constexpr std::uint16_t kStateBits = 0x008F;
  const bool goes_on = operating() && wanted == command::kEnableOperation;
  if (!goes_on || (controlword_ & kStateBits) != wanted) {
    if (Status status = send_controlword(wanted); !status) return status;
  }
  if (command.mode == AxisCommandMode::kNone) return {};
  if (reading_.state != AxisState::kReady && reading_.state != AxisState::kMoving) {
    return unavailable("the drive is not ready");
  }
  if (command.mode == AxisCommandMode::kStop) {
    return send_controlword(command::kEnableOperation | command::kHalt);
  }
  const bool cyclic = command.mode == AxisCommandMode::kCyclic && cyclic_offered_;
  const double position_m =
      cyclic ? command.position_m : command.target_m.value_or(command.position_m);
  if (!std::isfinite(position_m)) {
    return Error{ErrorCode::kInvalidArgument, "the commanded position is not finite"};
  }
  constexpr double kTolerance_m = 1e-6;
  if (position_m < limits_.lower_m - kTolerance_m || position_m > limits_.upper_m + kTolerance_m) {
    return Error{ErrorCode::kOutOfRange, "the commanded position lies outside the limits"};
  }
  return cyclic ? write_cyclic(position_m) : move_by_profile(position_m);
}

Status ModbusAxisDriver::write_cyclic(double position_m) {
  if (Status status = ensure_mode(Mode::kCyclicPosition); !status) return status;
  if (controlword_ != command::kEnableOperation) {
    if (Status status = send_controlword(command::kEnableOperation); !status) return status;
  }
  return set(kTargetPosition, counts(position_m));
}

Status ModbusAxisDriver::enable(Time) {
  if (reading_.state != AxisState::kDisabled || lost_) {
    return unavailable("the drive is enabled, in fault or in emergency stop");
  }
  power_off_when_standing_ = false;
  sequencer_.set_goal(Goal::kOperate);
  return {};
}

Status ModbusAxisDriver::disable(Time) {
  if (!connection_) return unavailable("the connection to the drive was lost");
  // Without power a moving axis would coast.
  power_off_when_standing_ = std::abs(reading_.velocity_mps) >= kStanding_mps;
  sequencer_.set_goal(power_off_when_standing_ ? Goal::kQuickStop : Goal::kPowerOff);
  return {};
}

Status ModbusAxisDriver::home(Time) {
  if (lost_) return unavailable("the connection to the drive was lost");
  const bool may = reading_.state == AxisState::kHoming || reading_.state == AxisState::kReady;
  if (!may || !operating()) return unavailable("the drive cannot home now");
  start_budget();
  const std::array<std::pair<Object, std::int32_t>, 4> settings{
      {{kHomingMethod, static_cast<std::int32_t>(parameters_.homing_method)},
       {kHomingSearchSpeed, counts(parameters_.homing_speed_mps)},
       {kHomingCreepSpeed, counts(parameters_.homing_speed_mps)},
       {kHomingAcceleration, counts(parameters_.homing_acceleration_mps2)}}};
  Status status = ensure_mode(Mode::kHoming);
  for (const auto& [object, value] : settings) {
    if (status.ok()) status = set(object, value);
  }
  if (status.ok()) status = send_controlword(command::kEnableOperation);
  if (status.ok()) status = send_controlword(command::kEnableOperation | command::kHomingStart);
  if (!status) return status;
  homing_ = true;
  reading_.homed = false;
  reading_.state = AxisState::kHoming;
  return {};
}

Status ModbusAxisDriver::emergency_stop(Time now) {
  emergency_stop_ = true;
  power_off_when_standing_ = false;
  homing_ = false;
  reading_.state = AxisState::kEmergencyStop;
  sequencer_.set_goal(Goal::kQuickStop);
  start_budget();
  if (!connection_) {
    // Each attempt may block for the budget: not in every cycle.
    if (now < next_reconnect_) return unavailable("no connection to the drive");
    next_reconnect_ = now + Duration::milliseconds(50);
    auto opened = GatewayConnection::open(parameters_.address, static_cast<int>(parameters_.port),
                                          static_cast<std::uint8_t>(parameters_.unit), *budget_);
    if (!opened) return opened.error();
    connection_ = std::move(*opened);
    mode_ = 0;
  }
  return send_controlword(command::kQuickStop);
}

Status ModbusAxisDriver::reset(Time now) {
  emergency_stop_ = false;
  homing_failed_ = false;
  power_off_when_standing_ = false;
  if (lost_) {
    // Anew, so that the drive is configured again: it may have been without power.
    lost_ = false;
    connection_.reset();
    if (Status status = read(now, Duration()); !status) return status;
  }
  const bool faulted = decode_state(statusword_) == State::kFault;
  sequencer_.set_goal(faulted ? Goal::kResetFault : Goal::kPowerOff);
  interpret(now);
  return {};
}

}  // namespace furrow::actuation::cia402
