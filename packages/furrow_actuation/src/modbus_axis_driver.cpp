#include "furrow_actuation/modbus_axis_driver.hpp"

#include <modbus.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::actuation::cia402 {
namespace {

constexpr Object kControlword{0x6040, 0, 2};
constexpr Object kStatusword{0x6041, 0, 2};
constexpr Object kModeOfOperation{0x6060, 0, 1};
constexpr Object kPosition{0x6064, 0, 4};
constexpr Object kVelocity{0x606C, 0, 4};
constexpr Object kTargetPosition{0x607A, 0, 4};
constexpr Object kLowerLimit{0x607D, 1, 4};
constexpr Object kUpperLimit{0x607D, 2, 4};
constexpr Object kProfileVelocity{0x6081, 0, 4};
constexpr Object kProfileAcceleration{0x6083, 0, 4};
constexpr Object kProfileDeceleration{0x6084, 0, 4};
constexpr Object kHomingMethod{0x6098, 0, 1};
constexpr Object kHomingSearchSpeed{0x6099, 1, 4};
constexpr Object kHomingCreepSpeed{0x6099, 2, 4};
constexpr Object kHomingAcceleration{0x609A, 0, 4};
constexpr Object kFollowingErrorValue{0x60F4, 0, 4};
constexpr Object kSupportedModes{0x6502, 0, 4};

Error unavailable(const char* why) {
  return {ErrorCode::kUnavailable, why};
}

}  // namespace

struct ModbusAxisDriver::Connection {
  explicit Connection(modbus_t* opened) : context(opened) {}
  ~Connection() {
    modbus_close(context);
    modbus_free(context);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  modbus_t* context;
};

void ModbusAxisParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "address", .description = "IP address of the drive"}, address);
  v.visit({.name = "port", .description = "its Modbus TCP port", .min = 1, .max = 65535}, port);
  v.visit({.name = "unit", .description = "its unit identifier", .min = 0, .max = 255}, unit);
  v.visit({.name = "timeout_s",
           .unit = "s",
           .description = "an exchange that takes longer is a lost connection",
           .min = 0.001,
           .max = 5.0},
          timeout_s);
  v.visit({.name = "counts_per_m",
           .description = "the drive's position units in a meter",
           .min = 1.0,
           .max = 1e8},
          counts_per_m);
  v.visit({.name = "homing_speed_mps",
           .unit = "m/s",
           .description = "speed of the search for the reference",
           .min = 1e-4,
           .max = 5.0},
          homing_speed_mps);
  v.visit({.name = "homing_acceleration_mps2",
           .unit = "m/s2",
           .description = "acceleration while homing",
           .min = 1e-3,
           .max = 100.0},
          homing_acceleration_mps2);
  v.visit({.name = "homing_method",
           .description = "object 6098h, as the drive's manual numbers the methods",
           .min = -128,
           .max = 127},
          homing_method);
  v.visit({.name = "has_following_error",
           .description = "the drive offers object 60F4h; otherwise its own limit alone watches"},
          has_following_error);
}

ModbusAxisDriver::ModbusAxisDriver(const MotionLimits& limits,
                                   const ModbusAxisParameters& parameters)
    : limits_(limits), parameters_(parameters) {
  if (!plan_s_curve(limits, {limits.lower_m, 0.0, 0.0}, limits.lower_m).ok()) {
    throw ConfigError("Modbus axis: the limits are not positive or not ordered");
  }
  const double greatest = std::max({std::abs(limits.lower_m), std::abs(limits.upper_m),
                                    limits.max_velocity_mps, limits.max_acceleration_mps2});
  if (!(parameters.counts_per_m > 0.0 && greatest * parameters.counts_per_m < 2e9)) {
    throw ConfigError("Modbus axis: the limits do not fit into the drive's units");
  }
}

ModbusAxisDriver::~ModbusAxisDriver() = default;

std::int32_t ModbusAxisDriver::counts(double meters) const {
  return static_cast<std::int32_t>(std::lround(meters * parameters_.counts_per_m));
}

bool ModbusAxisDriver::powered() const {
  return decode_state(statusword_) == State::kOperationEnabled;
}

void ModbusAxisDriver::lose_connection() {
  connection_.reset();
  lost_ = true;
  homing_ = false;
  reading_.homed = false;
  reading_.state = AxisState::kFault;
  reading_.fault = DriveFault::kConnectionLost;
  sequencer_.set_goal(Goal::kPowerOff);
}

Status ModbusAxisDriver::connect() {
  modbus_t* context =
      modbus_new_tcp(parameters_.address.c_str(), static_cast<int>(parameters_.port));
  if (context == nullptr) return unavailable("the drive's address is not usable");
  connection_ = std::make_unique<Connection>(context);
  const auto timeout_us = static_cast<std::uint32_t>(parameters_.timeout_s * 1e6);
  modbus_set_response_timeout(context, timeout_us / 1000000, timeout_us % 1000000);
  if (modbus_connect(context) != 0) {
    lose_connection();
    return unavailable("no connection to the drive");
  }
  mode_ = 0;
  controlword_ = 0;
  if (Status status = configure(); !status) {
    lose_connection();
    return status;
  }
  return {};
}

Status ModbusAxisDriver::configure() {
  const std::array<std::pair<Object, std::int32_t>, 5> settings{
      {{kLowerLimit, counts(limits_.lower_m)},
       {kUpperLimit, counts(limits_.upper_m)},
       {kProfileVelocity, counts(limits_.max_velocity_mps)},
       {kProfileAcceleration, counts(limits_.max_acceleration_mps2)},
       {kProfileDeceleration, counts(limits_.max_acceleration_mps2)}}};
  for (const auto& [object, value] : settings) {
    if (Status status = set(object, value); !status) return status;
  }
  const auto modes = get(kSupportedModes);
  if (!modes && lost_) return modes.error();
  constexpr int kCyclicPositionBit = 7;
  cyclic_offered_ = modes.ok() && (*modes >> kCyclicPositionBit & 1) != 0;
  return {};
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
  modbus_t* context = connection_->context;
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> answer{};
  Telegram addressed = request;
  addressed[0] = static_cast<std::uint8_t>(parameters_.unit);
  if (modbus_send_raw_request(context, addressed.begin(), static_cast<int>(addressed.size())) < 0) {
    lose_connection();
    return unavailable("the drive does not take requests");
  }
  // libmodbus does not know the function's length: it reads up to the MEI type, the rest is ours.
  const int head = modbus_receive_confirmation(context, answer.data());
  constexpr int kMbapBytes = 6;
  const int total = head < kMbapBytes ? 0 : kMbapBytes + (answer[4] << 8 | answer[5]);
  int filled = head;
  while (filled > 0 && filled < total && total <= static_cast<int>(answer.size())) {
    pollfd waiting{modbus_get_socket(context), POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(std::ceil(parameters_.timeout_s * 1e3))) <= 0) break;
    const auto got =
        recv(waiting.fd, answer.data() + filled, static_cast<std::size_t>(total - filled), 0);
    if (got <= 0) break;
    filled += static_cast<int>(got);
  }
  if (head <= 0 || filled != total) {
    lose_connection();
    return unavailable("the drive does not answer");
  }
  const std::span<const std::uint8_t> telegram(answer.data() + kMbapBytes,
                                               static_cast<std::size_t>(total - kMbapBytes));
  auto value = parse_response(telegram, object, write);
  if (!value && value.error().code == ErrorCode::kParse) lose_connection();
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
  if (lost_) return unavailable("the connection to the drive was lost");
  if (!connection_) {
    if (Status status = connect(); !status) return status;
  }
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
  interpret(now);
  return {};
}

void ModbusAxisDriver::interpret(Time now) {
  reading_.stamp = now;
  const auto state = decode_state(statusword_);
  const bool faulted = state == State::kFault || state == State::kFaultReactionActive;
  if (faulted) {
    homing_ = false;
    const bool following = (statusword_ & status_bit::kFollowingError) != 0;
    reading_.fault = following ? DriveFault::kFollowingError : DriveFault::kDrive;
  } else if (!homing_failed_) {
    reading_.fault = DriveFault::kNone;
  }
  if (homing_ && state == State::kOperationEnabled) {
    const bool attained = (statusword_ & status_bit::kHomingAttained) != 0;
    if ((statusword_ & status_bit::kHomingError) != 0) {
      homing_ = false;
      homing_failed_ = true;
      reading_.fault = DriveFault::kHomingFailed;
      sequencer_.set_goal(Goal::kPowerOff);
    } else if (attained && (statusword_ & status_bit::kTargetReached) != 0) {
      homing_ = false;
      reading_.homed = true;
    }
  }
  if (emergency_stop_) {
    reading_.state = AxisState::kEmergencyStop;
  } else if (faulted || homing_failed_) {
    reading_.state = AxisState::kFault;
  } else if (state != State::kOperationEnabled) {
    reading_.state = AxisState::kDisabled;
    homing_ = false;
  } else if (!reading_.homed) {
    reading_.state = AxisState::kHoming;
  } else {
    const bool moving = (statusword_ & status_bit::kTargetReached) == 0;
    reading_.state = moving ? AxisState::kMoving : AxisState::kReady;
  }
}

Status ModbusAxisDriver::write(Time, Duration, const AxisCommand& command) {
  if (lost_ || !connection_) return unavailable("no connection to the drive");
  const std::uint16_t wanted = sequencer_.next(statusword_);
  if (sequencer_.goal() == Goal::kResetFault && sequencer_.reached(statusword_)) {
    sequencer_.set_goal(Goal::kPowerOff);
  }
  constexpr std::uint16_t kStateBits = 0x008F;
  const bool operating = powered() && wanted == command::kEnableOperation;
  if (!operating || (controlword_ & kStateBits) != wanted) {
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
  if (!cyclic) return move_by_profile(position_m);
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
  sequencer_.set_goal(Goal::kOperate);
  return {};
}

Status ModbusAxisDriver::disable(Time) {
  if (lost_) return unavailable("the connection to the drive was lost");
  sequencer_.set_goal(emergency_stop_ ? Goal::kQuickStop : Goal::kPowerOff);
  return {};
}

Status ModbusAxisDriver::home(Time) {
  if (lost_) return unavailable("the connection to the drive was lost");
  const bool may = reading_.state == AxisState::kHoming || reading_.state == AxisState::kReady;
  if (!may || !powered()) return unavailable("the drive cannot home now");
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

Status ModbusAxisDriver::emergency_stop(Time) {
  emergency_stop_ = true;
  homing_ = false;
  reading_.state = AxisState::kEmergencyStop;
  sequencer_.set_goal(Goal::kQuickStop);
  if (lost_ || !connection_) return unavailable("no connection to the drive");
  return send_controlword(sequencer_.next(statusword_));
}

Status ModbusAxisDriver::reset(Time now) {
  if (lost_) {
    lost_ = false;
    if (Status status = read(now, Duration()); !status) return status;
  }
  emergency_stop_ = false;
  homing_failed_ = false;
  const bool faulted = decode_state(statusword_) == State::kFault;
  sequencer_.set_goal(faulted ? Goal::kResetFault : Goal::kPowerOff);
  interpret(now);
  return {};
}

}  // namespace furrow::actuation::cia402
