#include <algorithm>
#include <cmath>

#include "furrow_actuation/axis_controller.hpp"

namespace furrow::actuation {
namespace {

Duration half(Duration d) {
  return Duration::nanoseconds(d.count_ns() / 2);
}

/// How far the axis still is from `q_m` after `time_s` of its quickest way there.
double distance_left_m(const MotionLimits& limits, const MotionState& from, double q_m,
                       double time_s) {
  const auto profile = plan_s_curve(limits, from, q_m);
  const MotionState at = profile.ok() ? profile->at(std::max(0.0, time_s)) : from;
  return std::abs(at.position_m - q_m);
}

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

}  // namespace

void AxisController::run(Time now, Duration period) {
  if (spray_) supervise_spray(now, period);
  if (!spray_) approach(now, period);
}

void AxisController::approach(Time now, Duration period) {
  if (passing_) {
    const PlannedStop stop = *passing_;
    const auto aim = aim_at(stop);
    if (!aim) return;  // the robot stands: wait
    if (fire_when_due(stop, *aim, true, now, period)) passing_.reset();
    if (spray_ || passing_) return;
    hurry(now);
  }
  bool may_advance = true;
  for (std::size_t i = next_stop_; i < plan_.size() && !spray_ && !events_full(); ++i) {
    const bool done = finished(plan_[i]) || approach_stop(i, now, period);
    if (done && may_advance) {
      next_stop_ = i + 1;
    } else if (!done) {
      // An unreachable stop that is not due yet lets the one after it have its turn.
      const auto aim = aim_at(plan_[i]);
      if (!aim || aim->reachable) break;
      may_advance = false;
    }
  }
}

std::optional<AxisController::Aim> AxisController::aim_at(const PlannedStop& stop) const {
  const auto crossing = find_crossing(*base_, axis_, droplet_, stop.p_F, 0.0, parameters_.crossing);
  if (!crossing) return std::nullopt;
  Aim aim;
  aim.crossing = *crossing;
  aim.window = valve_window(crossing->emission, parameters_.dwell_s, calibration_);
  aim.q_m = std::clamp(crossing->q_m, limits_.lower_m, limits_.upper_m);
  aim.reachable = std::abs(aim.q_m - crossing->q_m) <= parameters_.placement_tolerance_m;
  return aim;
}

bool AxisController::approach_stop(std::size_t index, Time now, Duration period) {
  const PlannedStop& stop = plan_[index];
  const auto aim = aim_at(stop);
  if (!aim) return false;
  if (progress_.motion_s(stop.observed, now) > parameters_.max_target_age_s) {
    skip(stop, SkipReason::kStale, now);
    return true;
  }
  if (!aim->reachable) {
    if (aim->window.open_command > now) return false;
    skip(stop, SkipReason::kUnreachable, now);
    return true;
  }
  if (stop.fire_while_moving && try_passing(index, *aim, now, period)) return false;
  const double available_s = (aim->crossing.emission - now).to_seconds();
  // Late on the last millimetres, as after a small correction of the pose, is near enough: whether
  // the spray lands well is then asked when it is due.
  if (arrival_s(aim->q_m, now) > available_s + parameters_.late_slack_s &&
      distance_left_m(limits_, setpoint_, aim->q_m, available_s) >
          parameters_.placement_tolerance_m) {
    skip(stop, SkipReason::kLate, now);
    return true;
  }
  move_to(aim->q_m, now);
  return fire_when_due(stop, *aim, false, now, period);
}

bool AxisController::try_passing(std::size_t index, const Aim& aim, Time now, Duration period) {
  if (index + 1 >= plan_.size()) return false;
  const auto after = aim_at(plan_[index + 1]);
  if (!after || !after->reachable) return false;
  MotionLimits slow = limits_;
  slow.max_velocity_mps = std::min(slow.max_velocity_mps, parameters_.max_fire_speed_mps);
  // A run-up short before the aim: long enough to pass it at the firing speed.
  const double speed = slow.max_velocity_mps;
  const double flight_s = droplet_.carry * droplet_.fall_s;
  const double ramp_s =
      speed / slow.max_acceleration_mps2 + slow.max_acceleration_mps2 / slow.max_jerk_mps3;
  const double sign = after->q_m > aim.q_m ? 1.0 : -1.0;
  const double run_up_m = speed * (ramp_s / 2.0 + flight_s + parameters_.dwell_s);
  const double from_m = std::clamp(aim.q_m - sign * run_up_m, limits_.lower_m, limits_.upper_m);
  const auto profile = plan_s_curve(slow, {from_m, 0.0, 0.0}, after->q_m);
  if (!profile.ok()) return false;
  // The droplets' point passes the aim when q + carry * fall * velocity does.
  const auto past = [&](double t_s) {
    const MotionState state = profile->at(t_s);
    return sign * (state.position_m + flight_s * state.velocity_mps - aim.q_m);
  };
  if (past(0.0) >= 0.0) return false;
  constexpr int kSteps = 64;
  double low = 0.0;
  double high = 0.0;
  for (int i = 1; i <= kSteps && past(high) < 0.0; ++i) {
    low = high;
    high = profile->duration_s() * i / kSteps;
  }
  if (past(high) < 0.0) return false;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2.0;
    (past(middle) < 0.0 ? low : high) = middle;
  }
  const Time departure = aim.crossing.emission - Duration::seconds(high);
  if (now + Duration::seconds(arrival_s(from_m, now)) > departure + half(period)) return false;
  move_to(from_m, now);
  const bool standing = setpoint_.velocity_mps == 0.0 && setpoint_.acceleration_mps2 == 0.0;
  if (standing && departure < now + half(period)) {
    const auto leave = plan_s_curve(slow, setpoint_, after->q_m);
    if (!leave.ok()) return false;
    profile_ = *leave;
    profile_start_ = now;
    passing_ = plan_[index];
  }
  return true;
}

void AxisController::hurry(Time now) {
  if (const auto profile = plan_s_curve(limits_, setpoint_, profile_.final_state().position_m);
      profile.ok()) {
    profile_ = *profile;
    profile_start_ = now;
  }
}

double AxisController::off_setpoint_m() const {
  return reading_->position_m - motion_at(reading_->stamp).position_m;
}

bool AxisController::at_rest(Time first) const {
  return std::abs(motion_at(first).velocity_mps) <= parameters_.rest_speed_mps &&
         std::abs(off_setpoint_m()) <= parameters_.settled_error_m;
}

AxisController::Landing AxisController::predict_landing(Time middle) const {
  // What the axis was off its setpoint when it was last read, it is taken to be off then, too.
  const double off_m = off_setpoint_m();
  const auto land = [&](Time time) {
    const MotionState state = motion_at(time);
    return landing_point(extrapolate(*base_, time), axis_, droplet_, state.position_m + off_m,
                         state.velocity_mps);
  };
  const Duration half_dwell = Duration::seconds(parameters_.dwell_s / 2.0);
  const double speed = std::max({std::abs(motion_at(middle - half_dwell).velocity_mps),
                                 std::abs(motion_at(middle).velocity_mps),
                                 std::abs(motion_at(middle + half_dwell).velocity_mps)});
  return {land(middle - half_dwell), land(middle), land(middle + half_dwell), speed};
}

bool AxisController::protects(const Landing& landing) const {
  return std::any_of(protected_.begin(), protected_.end(), [&](const ProtectedPlant& plant) {
    const double distance =
        std::min(distance_to_segment(plant.p_F, landing.first_F, landing.middle_F),
                 distance_to_segment(plant.p_F, landing.middle_F, landing.last_F));
    return !(distance >= parameters_.protection_radius_m);
  });
}

bool AxisController::fire_when_due(const PlannedStop& stop, const Aim& aim, bool passing, Time now,
                                   Duration period) {
  if (aim.window.open_command > now + half(period)) return false;
  // Ground that was passed had its turn: a robot that reversed drives back over it first.
  if (progress_.behind_m() > parameters_.reverse_tolerance_m) return false;
  if (last_close_ && (now - *last_close_).to_seconds() < parameters_.min_off_s) return false;
  const Time first = now + Duration::seconds(calibration_.open_delay_s);
  const Time middle = first + Duration::seconds(parameters_.dwell_s / 2.0);
  const bool restless = !passing && !at_rest(first);
  if (restless) {
    // On its last millimetres: the spray may wait for as long as it still lands near enough.
    const double behind_m =
        aim.crossing.closing_speed_mps * (middle - aim.crossing.emission).to_seconds();
    if (behind_m <= parameters_.placement_tolerance_m) return false;
  }
  const Landing landing = predict_landing(middle);
  constexpr double kSpeedMargin = 1.01;
  if (progress_.motion_s(stop.observed, now) > parameters_.max_target_age_s) {
    skip(stop, SkipReason::kStale, now);
  } else if (restless ||
             !((landing.middle_F - stop.p_F).norm() <= parameters_.placement_tolerance_m) ||
             !(landing.q_velocity_mps <= parameters_.max_fire_speed_mps * kSpeedMargin)) {
    skip(stop, SkipReason::kLate, now);
  } else if (protects(landing)) {
    skip(stop, SkipReason::kProtectedCrop, now);
  } else {
    Spray spray;
    spray.stop = stop;
    spray.emission = middle;
    spray.emission_end = first + Duration::seconds(parameters_.dwell_s);
    spray.close = spray.emission_end - Duration::seconds(calibration_.close_delay_s);
    spray.passing = passing;
    spray.dry_run = parameters_.dry_run;
    spray_ = spray;
    finish(stop);
    ControllerEvent event;
    event.kind = ControllerEventKind::kSprayOpened;
    event.time = now;
    event.stop_id = stop.stop_id;
    event.targets = stop.targets;
    event.aim_F = stop.p_F;
    event.p_F = landing.middle_F;
    event.landing = middle + Duration::seconds(droplet_.fall_s);
    event.q_m = reading_->position_m;
    event.dry_run = spray.dry_run;
    events_.push_back(event);
  }
  return true;
}

void AxisController::supervise_spray(Time now, Duration period) {
  if (spray_->open) {
    if (base_->twist_B.vx_mps < parameters_.crossing.min_speed_mps) {
      close_spray(now, SkipReason::kStanding);
    } else if (protects(predict_landing(spray_->emission))) {
      close_spray(now, SkipReason::kProtectedCrop);
    } else if (spray_->close <= now + half(period)) {
      close_spray(now, SkipReason::kNone);
    }
  }
  if (!spray_->open && spray_->emission_end <= now + half(period)) {
    if (spray_->passing) hurry(now);
    spray_.reset();
  }
}

void AxisController::close_spray(Time now, SkipReason reason) {
  if (!spray_->open) return;
  const Landing landing = predict_landing(spray_->emission);
  spray_->open = false;
  last_close_ = now;
  ControllerEvent event;
  event.kind = ControllerEventKind::kSprayClosed;
  event.time = now;
  event.stop_id = spray_->stop.stop_id;
  event.targets = spray_->stop.targets;
  event.aim_F = spray_->stop.p_F;
  event.p_F = landing.middle_F;
  event.landing = spray_->emission + Duration::seconds(droplet_.fall_s);
  event.q_m = reading_->position_m;
  event.reason = reason;
  event.dry_run = spray_->dry_run;
  events_.push_back(event);
}

}  // namespace furrow::actuation
