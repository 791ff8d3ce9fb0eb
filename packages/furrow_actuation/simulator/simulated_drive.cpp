#include "simulated_drive.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::actuation::drive_simulator {
namespace {

constexpr double kFollowingErrorWindow = 5000.0;
constexpr std::uint16_t kFollowingErrorCode = 0x8611;
constexpr std::uint16_t kConnectionErrorCode = 0x8100;  // of communication, by CiA 301
constexpr std::uint16_t kWatchdog = 0x2010;             // an object of this manufacturer

bool bit(std::uint16_t word, int n) {
  return (word >> n & 1) != 0;
}

}  // namespace

SimulatedDrive::SimulatedDrive() {
  parameters_ = {{{0x607A, 0}, 12345},   {{0x607D, 1}, -200000}, {{0x607D, 2}, 200000},
                 {{0x6081, 0}, 100000},  {{0x6083, 0}, 1000000}, {{0x6084, 0}, 1000000},
                 {{0x6085, 0}, 5000000}, {{0x6098, 0}, 37},      {{0x6099, 1}, 5000},
                 {{0x6099, 2}, 5000},    {{0x609A, 0}, 50000},   {{0x605A, 0}, 2},
                 {{0x605E, 0}, 1},       {{0x6007, 0}, 1},       {{kWatchdog, 0}, 0}};
}

void SimulatedDrive::enter(Phase phase) {
  if (phase_ == phase) return;
  phase_ = phase;
  if (told_) told_(phase);
}

double SimulatedDrive::parameter(std::uint16_t index, std::uint8_t sub) const {
  const auto found = parameters_.find({index, sub});
  if (found != parameters_.end()) return found->second;
  // What the drive does is fixed where its dictionary has no object for it.
  constexpr double kFixedDeceleration = 5000000.0;
  return index == 0x6085 ? kFixedDeceleration : 0.0;
}

std::uint16_t SimulatedDrive::statusword() const {
  std::uint16_t word = 1u << 9;  // remote
  switch (phase_) {
    case Phase::kStarting:
      break;
    case Phase::kLocked:
      word |= 0x40;
      break;
    case Phase::kPrepared:
      word |= 0x21;
      break;
    case Phase::kPoweredOn:
      word |= 0x33;
      break;
    case Phase::kOperating:
      word |= 0x37;
      break;
    case Phase::kQuickStop:
      word |= 0x17;
      break;
    case Phase::kReacting:
      word |= 0x1F;
      break;
    case Phase::kFaulted:
      word |= 0x08;
      break;
  }
  const bool standing = std::abs(velocity_) < 1.0;
  const bool there = standing && std::abs(position_ - target_) < 10.0;
  if (mode_ == 6 ? (standing && !homing_) : there) word |= 1u << 10;
  if (mode_ == 1 && acknowledged_) word |= 1u << 12;
  if (mode_ == 8 && phase_ == Phase::kOperating) word |= 1u << 12;
  if (mode_ == 6 && homed_) word |= 1u << 12;
  if (mode_ == 6 ? homing_error_ : following_error_) word |= 1u << 13;
  return word;
}

std::optional<std::int32_t> SimulatedDrive::read(std::uint16_t index, std::uint8_t sub) const {
  if (const auto found = parameters_.find({index, sub}); found != parameters_.end()) {
    return found->second;
  }
  if (sub != 0) return std::nullopt;
  switch (index) {
    case 0x603F:
      return error_code_;
    case 0x6040:
      return controlword_;
    case 0x6041:
      return statusword();
    case 0x6060:
    case 0x6061:
      return mode_;
    case 0x6064:
      return static_cast<std::int32_t>(std::lround(position_));
    case 0x606C:
      return static_cast<std::int32_t>(std::lround(velocity_));
    case 0x6502:  // profile position, homing, and cyclic position where offered
      return cyclic_offered_ ? 0xA1 : 0x21;
    case 0x60F4:
      return static_cast<std::int32_t>(std::lround(demand_ - position_));
    default:
      return std::nullopt;
  }
}

SimulatedDrive::Answer SimulatedDrive::write(std::uint16_t index, std::uint8_t sub,
                                             std::int32_t value) {
  if (index == 0x6040 && sub == 0) {
    take_controlword(static_cast<std::uint16_t>(value));
    return Answer::kOk;
  }
  if (index == 0x6060 && sub == 0) {
    const bool offered = value == 1 || value == 6 || (value == 8 && cyclic_offered_);
    if (!offered) return Answer::kBadValue;
    mode_ = value;
    target_ = demand_;
    parameters_[{0x607A, 0}] = static_cast<std::int32_t>(std::lround(demand_));
    return Answer::kOk;
  }
  const auto found = parameters_.find({index, sub});
  if (found == parameters_.end()) {
    return read(index, sub) ? Answer::kReadOnly : Answer::kNoObject;
  }
  const bool option = index == 0x605A || index == 0x605E || index == 0x6007;
  const bool known_option = index == 0x605A   ? value == 2 || value == 6
                            : index == 0x605E ? value >= 0 && value <= 2
                                              : value >= 0 && value <= 3;
  if (option ? !known_option : index == kWatchdog && value < 0) return Answer::kBadValue;
  if (option || index == kWatchdog) {
    found->second = value;
    return Answer::kOk;
  }
  const bool position = index == 0x607A;
  if (position && (value < parameter(0x607D, 1) || value > parameter(0x607D, 2))) {
    return Answer::kBadValue;
  }
  if (!position && index != 0x607D && index != 0x6098 && value <= 0) return Answer::kBadValue;
  found->second = value;
  return Answer::kOk;
}

void SimulatedDrive::take_controlword(std::uint16_t word) {
  const bool reset_edge = bit(word, 7) && !bit(controlword_, 7);
  const std::uint16_t before = controlword_;
  controlword_ = word;
  if (phase_ == Phase::kFaulted) {
    if (reset_edge && !cause_lasts_) {
      enter(Phase::kLocked);
      error_code_ = 0;
      following_error_ = false;
    }
    return;
  }
  if (phase_ == Phase::kStarting || phase_ == Phase::kReacting) return;
  change_phase(word, before);
  if (phase_ != Phase::kOperating) homing_ = false;
}

void SimulatedDrive::change_phase(std::uint16_t word, std::uint16_t before) {
  const bool powered = phase_ == Phase::kOperating || phase_ == Phase::kQuickStop;
  if (!bit(word, 1)) {  // disable voltage, from every state
    enter(Phase::kLocked);
  } else if (!bit(word, 2)) {  // quick stop
    enter(powered ? Phase::kQuickStop : Phase::kLocked);
  } else if (phase_ == Phase::kQuickStop) {
    return;                    // leaves by disable voltage only
  } else if (!bit(word, 0)) {  // shutdown
    enter(Phase::kPrepared);
  } else if (phase_ == Phase::kPrepared || (phase_ == Phase::kOperating && !bit(word, 3))) {
    enter(Phase::kPoweredOn);  // switch on; disable operation
  } else if (phase_ == Phase::kPoweredOn && bit(word, 3)) {
    enter(Phase::kOperating);
    demand_ = target_ = position_;
    parameters_[{0x607A, 0}] = static_cast<std::int32_t>(std::lround(position_));
  } else if (phase_ == Phase::kOperating) {
    if (bit(word, 4) && !bit(before, 4)) start_action();
    if (!bit(word, 4)) acknowledged_ = false;
  }
}

void SimulatedDrive::start_action() {
  if (mode_ == 1) {
    target_ = parameter(0x607A);
    acknowledged_ = true;
  } else if (mode_ == 6) {
    homing_ = true;
    homed_ = false;
    homing_error_ = false;
  }
}

void SimulatedDrive::fault(std::uint16_t error_code) {
  if (phase_ == Phase::kFaulted) return;
  cause_lasts_ = true;
  error_code_ = error_code;
  homing_ = false;
  enter(Phase::kReacting);
}

void SimulatedDrive::brake(double deceleration, double h) {
  const double slower = std::max(0.0, std::abs(velocity_) - deceleration * h);
  velocity_ = std::copysign(slower, velocity_);
  demand_ += velocity_ * h;
}

void SimulatedDrive::move_towards(double target, double speed, double acceleration, double h) {
  const double distance = target - demand_;
  const double allowed = std::min(speed, std::sqrt(2.0 * acceleration * std::abs(distance)));
  const double wanted = std::min(allowed, std::abs(distance) / h);
  const double goal = std::copysign(wanted, distance);
  velocity_ += std::clamp(goal - velocity_, -acceleration * h * 1.5, acceleration * h);
  velocity_ = std::clamp(velocity_, -speed, speed);
  demand_ += velocity_ * h;
  if (std::abs(target - demand_) < 1.0 && std::abs(velocity_) < 2.0 * acceleration * h) {
    demand_ = target;
    velocity_ = 0.0;
  }
}

void SimulatedDrive::advance(double seconds) {
  constexpr double kStep = 1e-4;
  unsimulated_s_ += seconds;
  const auto steps = static_cast<int>(std::floor(unsimulated_s_ / kStep + 1e-6));
  unsimulated_s_ = std::max(0.0, unsimulated_s_ - steps * kStep);
  for (int i = 0; i < steps; ++i) {
    watch_connection(kStep);
    step(kStep);
  }
}

void SimulatedDrive::watch_connection(double h) {
  unheard_s_ += h;
  const auto limit = parameters_.find({kWatchdog, 0});
  if (limit == parameters_.end() || limit->second == 0) return;
  if (phase_ != Phase::kOperating || unheard_s_ * 1e3 <= limit->second) return;
  const double option = parameter(0x6007);
  watchdog_acted_ = option != 0;
  if (option == 1) {
    fault(kConnectionErrorCode);
    cause_lasts_ = false;
  } else if (option == 2) {
    enter(Phase::kLocked);
  } else if (option == 3) {
    enter(Phase::kQuickStop);
  }
}

void SimulatedDrive::step(double h) {
  switch (phase_) {
    case Phase::kStarting:
      enter(Phase::kLocked);
      break;
    case Phase::kReacting:
      brake(parameter(0x6085), h);
      if (velocity_ == 0.0) enter(Phase::kFaulted);
      break;
    case Phase::kOperating:
      operate(h);
      break;
    case Phase::kQuickStop:
      brake(parameter(0x6085), h);
      if (velocity_ == 0.0 && parameter(0x605A) == 2) enter(Phase::kLocked);
      break;
    default:
      brake(parameter(0x6085), h);
      break;
  }
  if (!jammed_) position_ = demand_;
  if (phase_ == Phase::kOperating && std::abs(demand_ - position_) > kFollowingErrorWindow) {
    following_error_ = true;
    fault(kFollowingErrorCode);
    velocity_ = 0.0;
    demand_ = position_;
    cause_lasts_ = false;
  }
}

void SimulatedDrive::operate(double h) {
  if (bit(controlword_, 8)) {
    brake(parameter(0x6084), h);
    target_ = demand_;
  } else if (mode_ == 1) {
    move_towards(target_, parameter(0x6081), parameter(0x6083), h);
  } else if (mode_ == 8) {
    target_ = parameter(0x607A);
    const double v = std::clamp((target_ - demand_) / 1e-3, -parameter(0x6081), parameter(0x6081));
    velocity_ = v;
    demand_ += v * h;
  } else if (mode_ == 6 && homing_) {
    home(h);
  }
}

void SimulatedDrive::home(double h) {
  if (reference_missing_) {
    homing_ = false;
    homing_error_ = true;
    return;
  }
  move_towards(0.0, parameter(0x6099, 1), parameter(0x609A), h);
  if (demand_ == 0.0 && velocity_ == 0.0) {
    homing_ = false;
    homed_ = true;
    target_ = 0.0;
  }
}

}  // namespace furrow::actuation::drive_simulator
