#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "furrow_actuation/bounded_vector.hpp"

namespace furrow::actuation {

/// What the safety of a tool depends on.
enum class SafetyInput : std::uint8_t {
  kEmergencyStop,
  kHeartbeat,  ///< of the planner
  kPlan,
  kTracks,
  kOdometry,
  kDrive,
  kValve,
  kLoop,   ///< the control loop itself
  kStore,  ///< the file that keeps latches over a restart
};
[[nodiscard]] std::string_view to_string(SafetyInput input);

/// Why a tool enters the safe state. All but kNone are latched until their reset.
enum class SafetyCause : std::uint8_t {
  kNone,
  kEmergencyStop,
  kPeerLost,            ///< no heartbeat of the planner within its deadline
  kPlanStale,           ///< no plan within its deadline
  kOdometryStale,       ///< no odometry within its deadline
  kOdometryInvalid,     ///< odometry that is not finite
  kReadingStale,        ///< the drive does not answer within its deadline
  kDriveFault,          ///< the drive reports a fault, or lost power while in use
  kPositionLimit,       ///< measured position outside the limits
  kFollowingError,      ///< too far from the commanded position for too long
  kValveFault,          ///< the valve does not confirm its level within its deadline
  kProtectionOverflow,  ///< more protected plants than can be checked
  kProtectionInvalid,   ///< a protected plant whose position is not finite
  kTracksStale,         ///< the newest image in the tracks is older than the deadline
  kLoopStalled,         ///< the control loop did not run for longer than its deadline
  kLatchesUnknown,      ///< the file of latches cannot be read
};
inline constexpr std::size_t kSafetyCauses = 16;  ///< kNone included
[[nodiscard]] std::string_view to_string(SafetyCause cause);
/// The cause of this name; nothing when there is none.
[[nodiscard]] std::optional<SafetyCause> safety_cause(std::string_view name);

/// Stop categories of IEC 60204-1 (terms only; no conformity is claimed). The valve is shut first
/// in both.
enum class StopCategory : std::uint8_t {
  kStandAndHold,       ///< category 2: a controlled stop, the drive stays powered and holds
  kQuickStopPowerOff,  ///< category 1: quick stop, then the drive's power is removed
};
[[nodiscard]] std::string_view to_string(StopCategory category);

/// The declared reaction to a cause.
struct SafetyRule {
  SafetyCause cause = SafetyCause::kNone;
  SafetyInput input = SafetyInput::kLoop;
  StopCategory stop = StopCategory::kQuickStopPowerOff;
  /// The cause passes when a process or the network is back: `--resume` may reset it.
  bool lost_peer = false;
  /// Judged only while the tool runs: before, a missing input is waited for.
  bool running_only = false;
};

/// One rule for each cause, in the order of SafetyCause without kNone.
[[nodiscard]] std::span<const SafetyRule> safety_rules();
/// @pre cause is not kNone.
[[nodiscard]] const SafetyRule& rule_of(SafetyCause cause);

/// A set of causes.
class CauseSet {
 public:
  void insert(SafetyCause cause) { bits_ |= bit(cause); }
  void erase(SafetyCause cause) { bits_ &= ~bit(cause); }
  void clear() { bits_ = 0; }
  [[nodiscard]] bool contains(SafetyCause cause) const { return (bits_ & bit(cause)) != 0; }
  [[nodiscard]] bool empty() const { return bits_ == 0; }
  bool operator==(const CauseSet&) const = default;

  /// The causes in the order of SafetyCause.
  [[nodiscard]] BoundedVector<SafetyCause, kSafetyCauses> list() const;

 private:
  [[nodiscard]] static std::uint32_t bit(SafetyCause cause) {
    return cause == SafetyCause::kNone ? 0u : 1u << static_cast<unsigned>(cause);
  }
  std::uint32_t bits_ = 0;
};

}  // namespace furrow::actuation
