#include "furrow_actuation/cia402.hpp"

namespace furrow::actuation::cia402 {

std::string_view to_string(State state) {
  switch (state) {
    case State::kNotReadyToSwitchOn:
      return "not_ready_to_switch_on";
    case State::kSwitchOnDisabled:
      return "switch_on_disabled";
    case State::kReadyToSwitchOn:
      return "ready_to_switch_on";
    case State::kSwitchedOn:
      return "switched_on";
    case State::kOperationEnabled:
      return "operation_enabled";
    case State::kQuickStopActive:
      return "quick_stop_active";
    case State::kFaultReactionActive:
      return "fault_reaction_active";
    case State::kFault:
      return "fault";
  }
  return "unknown";
}

std::optional<State> decode_state(std::uint16_t statusword) {
  switch (statusword & 0x004F) {
    case 0x0000:
      return State::kNotReadyToSwitchOn;
    case 0x0040:
      return State::kSwitchOnDisabled;
    case 0x000F:
      return State::kFaultReactionActive;
    case 0x0008:
      return State::kFault;
    default:
      break;
  }
  switch (statusword & 0x006F) {
    case 0x0021:
      return State::kReadyToSwitchOn;
    case 0x0023:
      return State::kSwitchedOn;
    case 0x0027:
      return State::kOperationEnabled;
    case 0x0007:
      return State::kQuickStopActive;
    default:
      return std::nullopt;
  }
}

std::uint16_t Sequencer::next(std::uint16_t statusword) {
  const auto state = decode_state(statusword);
  const std::uint16_t idle = last_ & static_cast<std::uint16_t>(~command::kFaultReset);
  std::uint16_t word = idle;
  if (!state || *state == State::kNotReadyToSwitchOn || *state == State::kFaultReactionActive) {
    return last_ = word;
  }
  if (*state == State::kFault) {
    // The reset acts on a rising edge: between two attempts the bit falls.
    const bool rise = goal_ == Goal::kResetFault && (last_ & command::kFaultReset) == 0;
    return last_ = rise ? command::kFaultReset : command::kDisableVoltage;
  }
  switch (goal_) {
    case Goal::kPowerOff:
    case Goal::kResetFault:
      word = command::kDisableVoltage;
      break;
    case Goal::kQuickStop:
      word = *state == State::kOperationEnabled || *state == State::kQuickStopActive
                 ? command::kQuickStop
                 : command::kDisableVoltage;
      break;
    case Goal::kOperate:
      if (*state == State::kSwitchOnDisabled) word = command::kShutdown;
      if (*state == State::kReadyToSwitchOn) word = command::kSwitchOn;
      if (*state == State::kSwitchedOn) word = command::kEnableOperation;
      if (*state == State::kOperationEnabled) word = command::kEnableOperation;
      // Not every drive leaves Quick Stop Active to Operation Enabled: take the way over power off.
      if (*state == State::kQuickStopActive) word = command::kDisableVoltage;
      break;
  }
  return last_ = word;
}

bool Sequencer::reached(std::uint16_t statusword) const {
  const auto state = decode_state(statusword);
  if (!state) return false;
  switch (goal_) {
    case Goal::kPowerOff:
    case Goal::kResetFault:
      return *state == State::kSwitchOnDisabled;
    case Goal::kOperate:
      return *state == State::kOperationEnabled;
    case Goal::kQuickStop:
      return *state == State::kQuickStopActive || *state == State::kSwitchOnDisabled;
  }
  return false;
}

}  // namespace furrow::actuation::cia402
