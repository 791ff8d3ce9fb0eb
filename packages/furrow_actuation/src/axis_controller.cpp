#include "furrow_actuation/axis_controller.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

bool operational(AxisState state) {
  return state == AxisState::kReady || state == AxisState::kMoving;
}

bool older_than(Time stamp, Time now, double seconds) {
  // A stamp from the future is no fresher than one equally far in the past.
  return std::abs((now - stamp).to_seconds()) > seconds;
}

bool finite(const BaseState& base) {
  return std::isfinite(base.X_FB.x_m) && std::isfinite(base.X_FB.y_m) &&
         std::isfinite(base.X_FB.heading_rad) && std::isfinite(base.twist_B.vx_mps) &&
         std::isfinite(base.twist_B.vy_mps) && std::isfinite(base.twist_B.yaw_rate_radps);
}

}  // namespace

AxisController::AxisController(const geometry::AxisModel& axis,
                               const NozzleCalibration& calibration,
                               const AxisControllerParameters& parameters)
    : model_(axis),
      axis_(axis),
      limits_(MotionLimits::of(axis)),
      parameters_(parameters),
      meter_(calibration.flow_mlps) {
  if (!plan_s_curve(limits_, {limits_.lower_m, 0.0, 0.0}, limits_.lower_m).ok()) {
    throw ConfigError("axis " + axis.name + ": its limits are not positive or not ordered");
  }
  if (!(axis.nozzle.height_m > 0.0) || !(axis.nozzle.footprint_radius_m > 0.0)) {
    throw ConfigError("axis " + axis.name + ": its nozzle has no height or no footprint");
  }
  if (std::abs(axis.direction_B.head<2>().norm() - 1.0) > 1e-6) {
    throw ConfigError("axis " + axis.name + ": its direction is not a horizontal unit vector");
  }
  set_calibration(calibration);
}

void AxisController::set_calibration(const NozzleCalibration& calibration) {
  calibration_ = calibration;
  droplet_ = calibration.droplet(model_.nozzle.height_m);
  axis_ = model_;
  axis_.p_BN0.head<2>() += Eigen::Vector2d(calibration.offset_x_m, calibration.offset_y_m);
}

Status AxisController::set_plan(Time stamp, std::span<const PlannedStop> stops) {
  plan_.clear();
  next_stop_ = 0;
  plan_stamp_ = stamp;
  Status status;
  for (const PlannedStop& stop : stops) {
    if (!stop.p_F.allFinite() || stop.targets.empty()) {
      status = Error{ErrorCode::kInvalidArgument,
                     "a stop of the plan has no targets or a position that is not finite"};
    } else if (!plan_.push_back(stop)) {
      return Error{ErrorCode::kOutOfRange, "the plan holds more stops than can be taken"};
    }
  }
  return status;
}

void AxisController::set_odometry(const BaseState& base) {
  odometry_valid_ = finite(base);
  if (odometry_valid_) base_ = base;
}

void AxisController::set_protected(std::span<const ProtectedPlant> plants) {
  protected_.clear();
  protection_valid_ = true;
  for (const ProtectedPlant& plant : plants) {
    if (!plant.p_F.allFinite() || !protected_.push_back(plant)) protection_valid_ = false;
  }
}

void AxisController::set_reading(const AxisReading& reading) {
  reading_ = reading;
}

SafetyCause AxisController::find_cause(Time now) const {
  if (emergency_stop_) return SafetyCause::kEmergencyStop;
  if (reading_ && reading_->state == AxisState::kEmergencyStop) return SafetyCause::kEmergencyStop;
  if (valve_fault_) return SafetyCause::kValveFault;
  if (!protection_valid_) return SafetyCause::kProtectionOverflow;
  if (!odometry_valid_) return SafetyCause::kOdometryInvalid;
  return mode_ == ControllerMode::kRunning ? find_running_cause(now) : SafetyCause::kNone;
}

SafetyCause AxisController::find_running_cause(Time now) const {
  if (peer_lost_) return SafetyCause::kPeerLost;
  if (older_than(reading_->stamp, now, parameters_.reading_deadline_s)) {
    return SafetyCause::kReadingStale;
  }
  if (reading_->fault == DriveFault::kFollowingError) return SafetyCause::kFollowingError;
  if (reading_->fault == DriveFault::kPositionLimit) return SafetyCause::kPositionLimit;
  if (!operational(reading_->state) || !reading_->homed) return SafetyCause::kDriveFault;
  if (!std::isfinite(reading_->position_m) ||
      reading_->position_m < limits_.lower_m - parameters_.position_margin_m ||
      reading_->position_m > limits_.upper_m + parameters_.position_margin_m) {
    return SafetyCause::kPositionLimit;
  }
  if (following_error_since_ &&
      (now - *following_error_since_).to_seconds() >= parameters_.following_error_time_s) {
    return SafetyCause::kFollowingError;
  }
  if (older_than(base_->stamp, now, parameters_.odometry_deadline_s)) {
    return SafetyCause::kOdometryStale;
  }
  if (older_than(*plan_stamp_, now, parameters_.plan_deadline_s)) return SafetyCause::kPlanStale;
  return SafetyCause::kNone;
}

bool AxisController::everything_there(Time now) const {
  return reading_ && base_ && plan_stamp_ && !peer_lost_ && reading_->state == AxisState::kReady &&
         reading_->homed && !older_than(reading_->stamp, now, parameters_.reading_deadline_s) &&
         reading_->position_m >= limits_.lower_m - parameters_.position_margin_m &&
         reading_->position_m <= limits_.upper_m + parameters_.position_margin_m &&
         !older_than(base_->stamp, now, parameters_.odometry_deadline_s) &&
         !older_than(*plan_stamp_, now, parameters_.plan_deadline_s);
}

void AxisController::track_following_error(Time now) {
  const bool beyond =
      reading_ && !(std::abs(reading_->following_error_m) <= parameters_.following_error_limit_m);
  if (!beyond) {
    following_error_since_.reset();
  } else if (!following_error_since_) {
    following_error_since_ = now;
  }
}

void AxisController::make_safe(Time now, SafetyCause cause) {
  if (spray_) close_spray(now, SkipReason::kFault);
  spray_.reset();
  passing_.reset();
  mode_ = ControllerMode::kSafe;
  cause_ = cause;
  cause_time_ = now;
  profile_ = plan_stop(limits_, setpoint_);
  profile_start_ = now;
  ControllerEvent event;
  event.kind = ControllerEventKind::kMadeSafe;
  event.time = now;
  event.cause = cause;
  events_.push_back(event);
}

void AxisController::give_up_due_stops(Time now) {
  for (; next_stop_ < plan_.size() && !events_full(); ++next_stop_) {
    const PlannedStop& stop = plan_[next_stop_];
    if (finished(stop)) continue;
    if (!base_) break;
    const auto aim = aim_at(stop);
    if (!aim || aim->crossing.emission > now) break;
    skip(stop, SkipReason::kFault, now);
  }
}

ControllerOutput AxisController::update(Time now, Duration period) {
  events_.clear();
  setpoint_ = motion_at(now);
  follow_drive_after_gap(now, period);
  track_following_error(now);

  const bool stopped = (now - profile_start_).to_seconds() >= profile_.duration_s();
  if (reset_requested_ && mode_ == ControllerMode::kSafe && stopped) {
    reset_requested_ = false;
    mode_ = ControllerMode::kWaiting;
    cause_ = SafetyCause::kNone;
    ControllerEvent event;
    event.kind = ControllerEventKind::kReset;
    event.time = now;
    events_.push_back(event);
  }
  if (mode_ != ControllerMode::kSafe) reset_requested_ = false;

  const SafetyCause cause = find_cause(now);
  if (cause != SafetyCause::kNone && mode_ != ControllerMode::kSafe) make_safe(now, cause);
  if (mode_ == ControllerMode::kWaiting && everything_there(now)) {
    mode_ = ControllerMode::kRunning;
    adopt_drive_setpoint(now);
  }
  if (mode_ == ControllerMode::kRunning) {
    run(now, period);
  } else {
    give_up_due_stops(now);
  }

  ControllerOutput output;
  output.valve_open = spray_ && spray_->open && !spray_->dry_run;
  meter_.command(now, output.valve_open);
  const bool stopping = mode_ == ControllerMode::kSafe && reading_ && operational(reading_->state);
  if (stopping && (now - profile_start_).to_seconds() >= profile_.duration_s()) {
    adopt_drive_setpoint(now);
  }
  if (mode_ == ControllerMode::kRunning || stopping) {
    const MotionState end = motion_at(now + period);
    output.axis = {AxisCommandMode::kCyclic, end.position_m, end.velocity_mps,
                   profile_.final_state().position_m};
  } else if (reading_ && std::isfinite(reading_->position_m)) {
    profile_ = MotionProfile::standing(reading_->position_m);
    profile_start_ = now;
  }
  output.mode = mode_;
  output.cause = cause_;
  output.cause_time = cause_time_;
  output.events = events_;
  return output;
}

void AxisController::adopt_drive_setpoint(Time now) {
  const double q_m = reading_->position_m + reading_->following_error_m;
  if (!std::isfinite(q_m)) return;
  profile_ = MotionProfile::standing(std::clamp(q_m, limits_.lower_m, limits_.upper_m));
  profile_start_ = now;
  setpoint_ = motion_at(now);
}

void AxisController::follow_drive_after_gap(Time now, Duration period) {
  constexpr int kPeriodsOfGap = 3;
  const bool gap =
      last_update_ && (now - *last_update_).count_ns() > kPeriodsOfGap * period.count_ns();
  last_update_ = now;
  if (!gap || !reading_ || reading_->stamp + period < now) return;
  const double q_m = reading_->position_m + reading_->following_error_m;
  const double v_mps =
      std::clamp(reading_->velocity_mps, -limits_.max_velocity_mps, limits_.max_velocity_mps);
  if (!std::isfinite(q_m) || !std::isfinite(v_mps)) return;
  profile_ = plan_stop(limits_, {std::clamp(q_m, limits_.lower_m, limits_.upper_m), v_mps, 0.0});
  profile_start_ = now;
  setpoint_ = motion_at(now);
}

MotionState AxisController::motion_at(Time time) const {
  return profile_.at((time - profile_start_).to_seconds());
}

void AxisController::move_to(double q_m, Time now) {
  constexpr double kDeadband_m = 1e-4;
  if (std::abs(profile_.final_state().position_m - q_m) < kDeadband_m) return;
  if (const auto profile = plan_s_curve(limits_, setpoint_, q_m); profile.ok()) {
    profile_ = *profile;
  } else {
    profile_ = plan_stop(limits_, setpoint_);
  }
  profile_start_ = now;
}

double AxisController::arrival_s(double q_m, Time now) const {
  constexpr double kSame_m = 2e-4;
  if (std::abs(profile_.final_state().position_m - q_m) < kSame_m) {
    return std::max(0.0, profile_.duration_s() - (now - profile_start_).to_seconds());
  }
  const auto profile = plan_s_curve(limits_, setpoint_, q_m);
  return profile.ok() ? profile->duration_s() : plan_stop(limits_, setpoint_).duration_s();
}

void AxisController::finish(const PlannedStop& stop) {
  for (const std::int64_t id : stop.targets) finished_[finished_count_++ % finished_.size()] = id;
}

bool AxisController::finished(const PlannedStop& stop) const {
  const auto* end = finished_.data() + std::min(finished_count_, finished_.size());
  return std::all_of(stop.targets.begin(), stop.targets.end(),
                     [&](std::int64_t id) { return std::find(finished_.data(), end, id) != end; });
}

void AxisController::skip(const PlannedStop& stop, SkipReason reason, Time now) {
  finish(stop);
  ControllerEvent event;
  event.kind = ControllerEventKind::kStopSkipped;
  event.time = now;
  event.stop_id = stop.stop_id;
  event.targets = stop.targets;
  event.aim_F = stop.p_F;
  event.q_m = setpoint_.position_m;
  event.reason = reason;
  event.cause = reason == SkipReason::kFault ? cause_ : SafetyCause::kNone;
  events_.push_back(event);
}

bool AxisController::events_full() const {
  constexpr std::size_t kReserve = 4;
  return events_.size() + kReserve > events_.capacity();
}

}  // namespace furrow::actuation
