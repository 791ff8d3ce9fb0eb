#include "furrow_actuation/axis_controller.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

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
      safety_(parameters.safety, axis.lower_m, axis.upper_m),
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

Status AxisController::set_plan(Time now, std::span<const PlannedStop> stops) {
  plan_.clear();
  next_stop_ = 0;
  safety_.plan_came(now);
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

bool AxisController::set_odometry(Time arrival, const BaseState& base) {
  const bool valid = finite(base);
  // A last stamp in the future was left there by a step of this computer's clock.
  const bool reordered = valid && base_ && base.stamp <= base_->stamp && base_->stamp <= arrival;
  if (reordered || !safety_.odometry_came(arrival, base.stamp, valid)) return false;
  base_ = base;
  progress_.add(base);
  return true;
}

void AxisController::set_protected(Time newest_image, std::span<const ProtectedPlant> plants) {
  protected_.clear();
  Protection protection = Protection::kComplete;
  for (const ProtectedPlant& plant : plants) {
    if (!plant.p_F.allFinite()) {
      protection = Protection::kNotFinite;
    } else if (!protected_.push_back(plant)) {
      protection = Protection::kTooMany;
    }
  }
  safety_.tracks_came(newest_image, protection);
}

void AxisController::set_reading(Time now, const AxisReading& reading) {
  reading_ = reading;
  safety_.drive_read(reading, now);
}

void AxisController::obey_safety(Time now) {
  const bool ended = (now - profile_start_).to_seconds() >= profile_.duration_s();
  safety_.update(now, ended && !seen_moving(now));
  const ControllerMode before = mode_;
  mode_ = safety_.mode();
  if (before != mode_ && before == ControllerMode::kRunning) {
    const bool raised = mode_ == ControllerMode::kInactive;
    stop_motion(now, raised ? SkipReason::kInactive : SkipReason::kFault);
  }
  if (before != mode_ && mode_ == ControllerMode::kRunning) {
    adopt_drive_setpoint(now);
    if (before == ControllerMode::kInactive) progress_.begin_new_ground();
  }
  report_safety_events();
}

// Of a drive that stops by itself; the velocity of an old reading says nothing.
bool AxisController::seen_moving(Time now) const {
  constexpr double kMoving_mps = 0.01;
  return mode_ == ControllerMode::kSafe && reading_ && reading_->stamp == now &&
         std::abs(reading_->velocity_mps) > kMoving_mps;
}

void AxisController::stop_motion(Time now, SkipReason reason) {
  if (spray_) close_spray(now, reason);
  spray_.reset();
  passing_.reset();
  profile_ = plan_stop(limits_, setpoint_);
  profile_start_ = now;
}

void AxisController::report_safety_events() {
  for (const SafetyEvent& found : safety_.take_events()) {
    ControllerEvent event;
    switch (found.kind) {
      case SafetyEvent::Kind::kLatched:
        event.kind = ControllerEventKind::kSafeState;
        break;
      case SafetyEvent::Kind::kReset:
        event.kind = ControllerEventKind::kReset;
        break;
      case SafetyEvent::Kind::kResetRefused:
        event.kind = ControllerEventKind::kResetRefused;
        break;
    }
    event.time = found.time;
    event.cause = found.cause;
    events_.push_back(event);
  }
}

void AxisController::give_up_due_stops(Time now, SkipReason reason) {
  for (; next_stop_ < plan_.size() && !events_full(); ++next_stop_) {
    const PlannedStop& stop = plan_[next_stop_];
    if (finished(stop)) continue;
    if (!base_) break;
    const auto aim = aim_at(stop);
    if (!aim || aim->crossing.emission > now) break;
    skip(stop, reason, now);
  }
}

ControllerOutput AxisController::update(Time now, Duration period) {
  events_.clear();
  setpoint_ = motion_at(now);
  follow_drive_after_gap(now, period);
  obey_safety(now);
  if (mode_ == ControllerMode::kRunning) {
    run(now, period);
  } else {
    const bool raised = mode_ == ControllerMode::kInactive;
    give_up_due_stops(now, raised ? SkipReason::kInactive : SkipReason::kFault);
  }
  ControllerOutput output;
  output.valve_open = spray_ && spray_->open && !spray_->dry_run;
  meter_.command(now, output.valve_open);
  output.axis = axis_command(now, period);
  output.mode = mode_;
  output.cause = safety_.first_cause();
  output.cause_time = safety_.cause_time();
  output.events = events_;
  return output;
}

AxisCommand AxisController::axis_command(Time now, Duration period) {
  const bool holds =
      mode_ == ControllerMode::kInactive ||
      (mode_ == ControllerMode::kSafe && safety_.stop() == StopCategory::kStandAndHold);
  const bool stopping = holds && reading_ && in_service(*reading_);
  if (stopping && (now - profile_start_).to_seconds() >= profile_.duration_s()) {
    adopt_drive_setpoint(now);
  }
  if (mode_ == ControllerMode::kRunning || stopping) {
    const MotionState end = motion_at(now + period);
    return {AxisCommandMode::kCyclic, end.position_m, end.velocity_mps,
            profile_.final_state().position_m};
  }
  // The drive stops by itself, or does not take setpoints yet.
  if (reading_ && std::isfinite(reading_->position_m)) {
    profile_ = MotionProfile::standing(reading_->position_m);
    profile_start_ = now;
  }
  return {};
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
  event.cause = reason == SkipReason::kFault ? safety_.first_cause() : SafetyCause::kNone;
  events_.push_back(event);
}

bool AxisController::events_full() const {
  constexpr std::size_t kReserve = 4;
  return events_.size() + kReserve > events_.capacity();
}

}  // namespace furrow::actuation
