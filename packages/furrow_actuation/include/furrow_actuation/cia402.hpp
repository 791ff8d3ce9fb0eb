#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace furrow::actuation::cia402 {

/// States of the power drive system (CiA 402-2, IEC 61800-7-201: figure of the state machine).
enum class State {
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};
[[nodiscard]] std::string_view to_string(State state);

/// The state that a statusword (object 6041h) says; nothing for a pattern that the standard does
/// not name.
[[nodiscard]] std::optional<State> decode_state(std::uint16_t statusword);

namespace status_bit {
inline constexpr std::uint16_t kTargetReached = 1u << 10;
inline constexpr std::uint16_t kInternalLimit = 1u << 11;
inline constexpr std::uint16_t kSetpointAcknowledge = 1u << 12;  ///< profile position
inline constexpr std::uint16_t kHomingAttained = 1u << 12;       ///< homing
inline constexpr std::uint16_t kFollowingError = 1u << 13;       ///< profile, cyclic position
inline constexpr std::uint16_t kHomingError = 1u << 13;          ///< homing
}  // namespace status_bit

/// Controlwords (object 6040h) of the standard's commands.
namespace command {
inline constexpr std::uint16_t kDisableVoltage = 0x0000;
inline constexpr std::uint16_t kQuickStop = 0x0002;
inline constexpr std::uint16_t kShutdown = 0x0006;
inline constexpr std::uint16_t kSwitchOn = 0x0007;
inline constexpr std::uint16_t kEnableOperation = 0x000F;
inline constexpr std::uint16_t kFaultReset = 0x0080;          ///< on its rising edge
inline constexpr std::uint16_t kNewSetpoint = 1u << 4;        ///< profile position, rising edge
inline constexpr std::uint16_t kHomingStart = 1u << 4;        ///< homing
inline constexpr std::uint16_t kChangeImmediately = 1u << 5;  ///< profile position
inline constexpr std::uint16_t kHalt = 1u << 8;
}  // namespace command

/// Modes of operation (object 6060h).
enum class Mode : std::int8_t { kProfilePosition = 1, kHoming = 6, kCyclicPosition = 8 };

/// Where the drive shall be.
enum class Goal {
  kPowerOff,    ///< Switch On Disabled; a drive in fault stays there
  kOperate,     ///< Operation Enabled; a drive in fault stays there
  kQuickStop,   ///< stopped at once: Quick Stop Active, or unpowered
  kResetFault,  ///< out of Fault, to Switch On Disabled
};

/// Leads a drive to a goal, one controlword for each statusword that is read.
class Sequencer {
 public:
  void set_goal(Goal goal) { goal_ = goal; }
  [[nodiscard]] Goal goal() const { return goal_; }

  /// The controlword to send now. A statusword without a meaning, and states that the drive leaves
  /// by itself (Not Ready, Fault Reaction), repeat the last controlword without its fault reset.
  [[nodiscard]] std::uint16_t next(std::uint16_t statusword);
  [[nodiscard]] bool reached(std::uint16_t statusword) const;

 private:
  Goal goal_ = Goal::kPowerOff;
  std::uint16_t last_ = command::kDisableVoltage;
};

}  // namespace furrow::actuation::cia402
