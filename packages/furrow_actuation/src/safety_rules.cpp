#include "furrow_actuation/safety_rules.hpp"

#include <algorithm>
#include <cassert>

namespace furrow::actuation {
namespace {

using enum SafetyCause;
using enum StopCategory;
using Input = SafetyInput;

constexpr bool kPeer = true;
constexpr bool kRunningOnly = true;

constexpr std::array<SafetyRule, kSafetyCauses - 1> kRules{{
    {kEmergencyStop, Input::kEmergencyStop, kQuickStopPowerOff, !kPeer, !kRunningOnly},
    {kPeerLost, Input::kHeartbeat, kStandAndHold, kPeer, kRunningOnly},
    {kPlanStale, Input::kPlan, kStandAndHold, kPeer, kRunningOnly},
    {kOdometryStale, Input::kOdometry, kStandAndHold, kPeer, kRunningOnly},
    {kOdometryInvalid, Input::kOdometry, kStandAndHold, !kPeer, !kRunningOnly},
    {kReadingStale, Input::kDrive, kQuickStopPowerOff, !kPeer, kRunningOnly},
    {kDriveFault, Input::kDrive, kQuickStopPowerOff, !kPeer, kRunningOnly},
    {kPositionLimit, Input::kDrive, kQuickStopPowerOff, !kPeer, kRunningOnly},
    {kFollowingError, Input::kDrive, kQuickStopPowerOff, !kPeer, kRunningOnly},
    {kValveFault, Input::kValve, kQuickStopPowerOff, !kPeer, !kRunningOnly},
    {kProtectionOverflow, Input::kTracks, kStandAndHold, !kPeer, !kRunningOnly},
    {kProtectionInvalid, Input::kTracks, kStandAndHold, !kPeer, !kRunningOnly},
    {kTracksStale, Input::kTracks, kStandAndHold, kPeer, kRunningOnly},
    {kLoopStalled, Input::kLoop, kStandAndHold, !kPeer, kRunningOnly},
    {kLatchesUnknown, Input::kStore, kQuickStopPowerOff, !kPeer, !kRunningOnly},
}};

}  // namespace

std::span<const SafetyRule> safety_rules() {
  return kRules;
}

const SafetyRule& rule_of(SafetyCause cause) {
  assert(cause != kNone);
  const SafetyRule& rule = kRules[static_cast<std::size_t>(cause) - 1];
  assert(rule.cause == cause);
  return rule;
}

BoundedVector<SafetyCause, kSafetyCauses> CauseSet::list() const {
  BoundedVector<SafetyCause, kSafetyCauses> causes;
  for (const SafetyRule& rule : kRules) {
    if (contains(rule.cause)) causes.push_back(rule.cause);
  }
  return causes;
}

std::string_view to_string(SafetyInput input) {
  switch (input) {
    case Input::kEmergencyStop:
      return "emergency_stop";
    case Input::kHeartbeat:
      return "heartbeat";
    case Input::kPlan:
      return "plan";
    case Input::kTracks:
      return "tracks";
    case Input::kOdometry:
      return "odometry";
    case Input::kDrive:
      return "drive";
    case Input::kValve:
      return "valve";
    case Input::kLoop:
      return "loop";
    case Input::kStore:
      return "store";
  }
  return "unknown";
}

std::string_view to_string(SafetyCause cause) {
  switch (cause) {
    case kNone:
      return "none";
    case kEmergencyStop:
      return "emergency_stop";
    case kPeerLost:
      return "peer_lost";
    case kPlanStale:
      return "plan_stale";
    case kOdometryStale:
      return "odometry_stale";
    case kOdometryInvalid:
      return "odometry_invalid";
    case kReadingStale:
      return "reading_stale";
    case kDriveFault:
      return "drive_fault";
    case kPositionLimit:
      return "position_limit";
    case kFollowingError:
      return "following_error";
    case kValveFault:
      return "valve_fault";
    case kProtectionOverflow:
      return "protection_overflow";
    case kProtectionInvalid:
      return "protection_invalid";
    case kTracksStale:
      return "tracks_stale";
    case kLoopStalled:
      return "loop_stalled";
    case kLatchesUnknown:
      return "latches_unknown";
  }
  return "unknown";
}

std::optional<SafetyCause> safety_cause(std::string_view name) {
  const auto rule = std::ranges::find_if(
      kRules, [&](const SafetyRule& row) { return to_string(row.cause) == name; });
  if (rule == kRules.end()) return std::nullopt;
  return rule->cause;
}

std::string_view to_string(StopCategory category) {
  switch (category) {
    case kStandAndHold:
      return "stand_and_hold";
    case kQuickStopPowerOff:
      return "quick_stop_power_off";
  }
  return "unknown";
}

}  // namespace furrow::actuation
