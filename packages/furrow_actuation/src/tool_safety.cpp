#include "furrow_actuation/tool_safety.hpp"

#include <cmath>

namespace furrow::actuation {
namespace {

bool is_drive_cause(SafetyCause cause) {
  return rule_of(cause).input == SafetyInput::kDrive;
}

}  // namespace

ToolSafety::ToolSafety(const ToolSafetyParameters& parameters, double lower_m, double upper_m)
    : parameters_(parameters), lower_m_(lower_m), upper_m_(upper_m) {}

void ToolSafety::tracks_came(Time newest_image, Protection protection) {
  tracks_ = newest_image;
  protection_ = protection;
}

bool ToolSafety::odometry_came(Time arrival, Time stamp, bool finite) {
  odometry_finite_ = finite;
  if (!finite || older_than(stamp, arrival, parameters_.odometry_delay_limit_s)) return false;
  odometry_ = stamp;
  return true;
}

void ToolSafety::drive_read(const AxisReading& reading, Time now) {
  reading_ = reading;
  const bool beyond = !(std::abs(reading.following_error_m) <= parameters_.following_error_limit_m);
  if (!beyond) {
    following_error_since_.reset();
  } else if (!following_error_since_) {
    following_error_since_ = now;
  }
}

void ToolSafety::valve_written(Time now, bool open, bool confirmed) {
  valve_confirmed_shut_ = confirmed && !open;
  if (confirmed) {
    opening_failed_ = opening_failed_ && open;
    valve_unconfirmed_since_.reset();
    return;
  }
  if (open) opening_failed_ = true;
  if (!valve_unconfirmed_since_) valve_unconfirmed_since_ = now;
}

void ToolSafety::restore(const CauseSet& latched, Time now) {
  for (const SafetyCause cause : latched.list()) latch(cause, now);
}

void ToolSafety::request_reset(SafetyCause cause) {
  if (cause != SafetyCause::kNone) {
    if (latched_.contains(cause)) reset_requests_.insert(cause);
    return;
  }
  reset_requests_ = latched_;
}

bool ToolSafety::older_than(const std::optional<Time>& stamp, Time now, double seconds) const {
  // A stamp from the future is no fresher than one equally far in the past.
  return !stamp || std::abs((now - *stamp).to_seconds()) > seconds;
}

bool ToolSafety::holds(SafetyCause cause, Time now) const {
  switch (cause) {
    case SafetyCause::kNone:
    case SafetyCause::kLatchesUnknown:
      return false;
    case SafetyCause::kEmergencyStop:
      return emergency_stop_ || (mode_ == ControllerMode::kRunning && reading_ &&
                                 reading_->state == AxisState::kEmergencyStop);
    case SafetyCause::kPeerLost:
      return older_than(heartbeat_, now, parameters_.heartbeat_deadline_s);
    case SafetyCause::kPlanStale:
      return older_than(plan_, now, parameters_.plan_deadline_s);
    case SafetyCause::kTracksStale:
      return older_than(tracks_, now, parameters_.tracks_deadline_s);
    case SafetyCause::kOdometryStale:
      return older_than(odometry_, now, parameters_.odometry_deadline_s);
    case SafetyCause::kOdometryInvalid:
      return !odometry_finite_;
    case SafetyCause::kReadingStale:
      return !reading_ || reading_->fault == DriveFault::kConnectionLost ||
             older_than(reading_->stamp, now, parameters_.reading_deadline_s);
    case SafetyCause::kDriveFault:
      return drive_fault_holds();
    case SafetyCause::kPositionLimit:
      return position_limit_holds();
    case SafetyCause::kFollowingError:
      return following_error_holds(now);
    case SafetyCause::kValveFault:
      return valve_fault_holds(now);
    case SafetyCause::kProtectionOverflow:
      return protection_ == Protection::kTooMany;
    case SafetyCause::kProtectionInvalid:
      return protection_ == Protection::kNotFinite;
    case SafetyCause::kLoopStalled:
      return loop_stalled_;
  }
  return true;
}

// A fault that has a cause of its own is not told twice, nor is a drive that does not answer.
bool ToolSafety::drive_fault_holds() const {
  if (!reading_) return true;
  const bool other = reading_->fault == DriveFault::kFollowingError ||
                     reading_->fault == DriveFault::kPositionLimit ||
                     reading_->fault == DriveFault::kConnectionLost ||
                     reading_->state == AxisState::kEmergencyStop;
  return !other && !in_service(*reading_);
}

bool ToolSafety::position_limit_holds() const {
  if (!reading_) return false;
  const double q_m = reading_->position_m;
  return reading_->fault == DriveFault::kPositionLimit || !std::isfinite(q_m) ||
         q_m < lower_m_ - parameters_.position_margin_m ||
         q_m > upper_m_ + parameters_.position_margin_m;
}

bool ToolSafety::following_error_holds(Time now) const {
  if (reading_ && reading_->fault == DriveFault::kFollowingError) return true;
  return following_error_since_ &&
         (now - *following_error_since_).to_seconds() >= parameters_.following_error_time_s;
}

bool ToolSafety::valve_fault_holds(Time now) const {
  return opening_failed_ ||
         (valve_unconfirmed_since_ &&
          (now - *valve_unconfirmed_since_).to_seconds() >= parameters_.valve_deadline_s);
}

std::optional<SafetyInput> ToolSafety::missing(Time now) const {
  for (const SafetyRule& rule : safety_rules()) {
    if (rule.cause != SafetyCause::kLoopStalled && holds(rule.cause, now)) return rule.input;
  }
  if (!valve_confirmed_shut_) return SafetyInput::kValve;
  const bool ready = reading_ && reading_->state == AxisState::kReady && reading_->homed;
  return ready ? std::nullopt : std::optional(SafetyInput::kDrive);
}

void ToolSafety::note_loop(Time now) {
  loop_stalled_ = last_update_ && older_than(last_update_, now, parameters_.loop_deadline_s);
  last_update_ = now;
}

void ToolSafety::update(Time now, bool axis_stopped) {
  note_loop(now);
  if (mode_ == ControllerMode::kSafe && axis_stopped) answer_resets(now);
  latch_what_holds(now);
  choose_mode(now);
}

void ToolSafety::answer_resets(Time now) {
  for (const SafetyCause cause : reset_requests_.list()) {
    if (is_drive_cause(cause)) continue;
    if (holds(cause, now)) {
      refuse(cause, now);
    } else {
      unlatch(cause, now);
    }
  }
  answer_drive_resets(now);
}

void ToolSafety::answer_drive_resets(Time now) {
  const auto requested = reset_requests_.list();
  if (requested.empty()) {
    drive_recovering_ = false;
    return;
  }
  // A drive is not powered while another cause is latched.
  const bool alone = latched_ == reset_requests_;
  if (alone && !drive_recovering_) {
    drive_recovering_ = true;
    drive_busy_ = true;
    return;
  }
  const bool back =
      alone && reading_ && in_service(*reading_) && !holds(SafetyCause::kReadingStale, now);
  if (!back && alone && drive_busy_) return;
  for (const SafetyCause cause : requested) {
    if (back && !holds(cause, now)) {
      unlatch(cause, now);
    } else {
      refuse(cause, now);
    }
  }
  drive_recovering_ = false;
}

// A drive is judged from when it came into service until it is taken out. A raised tool neither
// sprays nor moves: it needs its drive and its loop, but no peer.
bool ToolSafety::judged(const SafetyRule& rule) const {
  if (!rule.running_only) return true;
  if (rule.input == SafetyInput::kDrive) return drive_in_service_;
  const bool raised = mode_ == ControllerMode::kInactive && !rule.lost_peer;
  return mode_ == ControllerMode::kRunning || raised;
}

void ToolSafety::latch_what_holds(Time now) {
  // All of them in the mode that they were found in: latching changes it.
  CauseSet found;
  for (const SafetyRule& rule : safety_rules()) {
    if (judged(rule) && holds(rule.cause, now)) found.insert(rule.cause);
  }
  for (const SafetyCause cause : found.list()) {
    if (!latched_.contains(cause)) latch(cause, now);
  }
}

bool ToolSafety::must_shut(Time now) const {
  if (mode_ != ControllerMode::kRunning || !active_) return true;
  if (older_than(last_update_, now, parameters_.loop_deadline_s)) return true;
  for (const SafetyRule& rule : safety_rules()) {
    if (rule.input != SafetyInput::kDrive && holds(rule.cause, now)) return true;
  }
  return false;
}

void ToolSafety::latch(SafetyCause cause, Time now) {
  if (latched_.empty()) {
    first_cause_ = cause;
    cause_time_ = now;
  }
  latched_.insert(cause);
  // Also a recovery of the drive that is under way ends here.
  for (const SafetyCause requested : reset_requests_.list()) refuse(requested, now);
  drive_recovering_ = false;
  mode_ = ControllerMode::kSafe;
  events_.push_back({SafetyEvent::Kind::kLatched, cause, now});
}

void ToolSafety::unlatch(SafetyCause cause, Time now) {
  latched_.erase(cause);
  reset_requests_.erase(cause);
  if (first_cause_ == cause) {
    const auto left = latched_.list();
    first_cause_ = left.empty() ? SafetyCause::kNone : left.front();
  }
  events_.push_back({SafetyEvent::Kind::kReset, cause, now});
}

void ToolSafety::refuse(SafetyCause cause, Time now) {
  reset_requests_.erase(cause);
  events_.push_back({SafetyEvent::Kind::kResetRefused, cause, now});
}

void ToolSafety::choose_mode(Time now) {
  if (!latched_.empty()) {
    mode_ = ControllerMode::kSafe;
    if (stop() == StopCategory::kQuickStopPowerOff) drive_in_service_ = false;
    return;
  }
  if (mode_ == ControllerMode::kSafe) mode_ = ControllerMode::kWaiting;
  if (!active_ && mode_ == ControllerMode::kRunning) mode_ = ControllerMode::kInactive;
  if (active_ && mode_ == ControllerMode::kInactive) mode_ = ControllerMode::kWaiting;
  if (mode_ == ControllerMode::kWaiting && !missing(now)) {
    mode_ = active_ ? ControllerMode::kRunning : ControllerMode::kInactive;
    drive_in_service_ = true;
  }
}

StopCategory ToolSafety::stop() const {
  for (const SafetyCause cause : latched_.list()) {
    if (rule_of(cause).stop == StopCategory::kQuickStopPowerOff) {
      return StopCategory::kQuickStopPowerOff;
    }
  }
  return StopCategory::kStandAndHold;
}

bool ToolSafety::drive_wanted() const {
  return mode_ != ControllerMode::kSafe || drive_recovering_ ||
         stop() == StopCategory::kStandAndHold;
}

SafetyEvents ToolSafety::take_events() {
  const SafetyEvents taken = events_;
  events_.clear();
  return taken;
}

}  // namespace furrow::actuation
