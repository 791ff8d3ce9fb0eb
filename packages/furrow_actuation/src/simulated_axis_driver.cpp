#include "furrow_actuation/simulated_axis_driver.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

constexpr double kPositionTolerance_m = 1e-6;
constexpr double kInPosition_m = 1e-4;

/// As hard as the acceleration limit allows, without regard to the jerk: a drive's quick stop.
MotionProfile quick_stop(const MotionLimits& limits, const MotionState& from) {
  const double stop_s = std::abs(from.velocity_mps) / limits.max_acceleration_mps2;
  MotionProfile profile({from.position_m, from.velocity_mps, 0.0});
  profile.append_acceleration(stop_s,
                              -std::copysign(limits.max_acceleration_mps2, from.velocity_mps));
  profile.set_final({profile.final_state().position_m, 0.0, 0.0});
  return profile;
}

Error unavailable(const char* why) {
  return {ErrorCode::kUnavailable, why};
}

}  // namespace

void SimulatedAxisParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "lag_s",
           .unit = "s",
           .description = "time constant with which the axis follows its setpoint; 0: ideally",
           .min = 0.0,
           .max = 1.0},
          lag_s);
  v.visit({.name = "following_error_limit_m",
           .unit = "m",
           .description = "following error at which the drive faults",
           .min = 1e-4},
          following_error_limit_m);
  v.visit({.name = "homing_speed_mps",
           .unit = "m/s",
           .description = "greatest speed while looking for the reference",
           .min = 1e-3},
          homing_speed_mps);
  v.visit({.name = "homing_timeout_s",
           .unit = "s",
           .description = "homing that takes longer has failed",
           .min = 0.1},
          homing_timeout_s);
  v.visit({.name = "start_position_m", .unit = "m", .description = "position at the start"},
          start_position_m);
  v.visit({.name = "start_ready",
           .description = "powered and homed from the start, as after a warm restart"},
          start_ready);
  v.visit({.name = "watchdog_s",
           .unit = "s",
           .description = "a simulated drive that is not called for longer makes a quick stop and "
                          "removes its power; 0: it has no watchdog",
           .min = 0.0,
           .max = 10.0},
          watchdog_s);
}

SimulatedAxisDriver::SimulatedAxisDriver(const MotionLimits& limits,
                                         const SimulatedAxisParameters& parameters)
    : limits_(limits), parameters_(parameters) {
  if (!plan_s_curve(limits, {parameters.start_position_m, 0.0, 0.0}, parameters.start_position_m)
           .ok()) {
    throw ConfigError("simulated axis: limits not positive, or the start lies outside of them");
  }
  setpoint_ = {parameters.start_position_m, 0.0, 0.0};
  profile_ = MotionProfile::standing(parameters.start_position_m);
  reading_.position_m = parameters.start_position_m;
  powered_ = parameters.start_ready;
  reading_.homed = parameters.start_ready;
  reading_.powered = powered_;
  reading_.state = parameters.start_ready ? AxisState::kReady : AxisState::kDisabled;
}

MotionState SimulatedAxisDriver::setpoint_at(Time time) const {
  if (mode_ == Setpoint::kCyclic) {
    const double length_s = (cyclic_end_ - cyclic_start_).to_seconds();
    const double share = std::clamp((time - cyclic_start_).to_seconds() / length_s, 0.0, 1.0);
    const double slope = (cyclic_to_.position_m - cyclic_from_.position_m) / length_s;
    return {cyclic_from_.position_m + share * length_s * slope,
            share < 1.0 ? slope : cyclic_to_.velocity_mps, cyclic_to_.acceleration_mps2};
  }
  return profile_.at((time - profile_start_).to_seconds());
}

void SimulatedAxisDriver::simulate_to(Time now) {
  if (!started_) {
    started_ = true;
    simulated_to_ = now;
    profile_start_ = now;
  }
  const Duration step = Duration::milliseconds(1);
  while (simulated_to_ < now) simulate_step(std::min(now, simulated_to_ + step));
  reading_.following_error_m = setpoint_.position_m - reading_.position_m;
}

void SimulatedAxisDriver::simulate_step(Time next) {
  if (mode_ == Setpoint::kCyclic && next > cyclic_end_ && cyclic_to_.velocity_mps != 0.0) {
    // The stream of setpoints has dried up: the drive stops by itself.
    profile_ = quick_stop(limits_, cyclic_to_);
    profile_start_ = cyclic_end_;
    mode_ = Setpoint::kProfile;
  }
  watch_contact(next);
  const MotionState from = setpoint_;
  setpoint_ = setpoint_at(next);
  follow_setpoint(from, (next - simulated_to_).to_seconds());
  simulated_to_ = next;
  const bool stands = setpoint_.velocity_mps == 0.0;
  if (powered_ || stands) reading_.powered = powered_;
}

void SimulatedAxisDriver::watch_contact(Time next) {
  if (parameters_.watchdog_s <= 0.0 || !powered_ || !last_contact_) return;
  if ((next - *last_contact_).to_seconds() <= parameters_.watchdog_s) return;
  fail(next, DriveFault::kConnectionLost);
  powered_ = false;
}

void SimulatedAxisDriver::follow_setpoint(const MotionState& from, double h) {
  if (jammed_) {
    reading_.velocity_mps = 0.0;
  } else if (parameters_.lag_s <= 0.0) {
    reading_.position_m = setpoint_.position_m;
    reading_.velocity_mps = setpoint_.velocity_mps;
  } else {
    // The exact answer of a first-order lag to a setpoint that is linear over the step.
    const double slope = (setpoint_.position_m - from.position_m) / h;
    const double steady_behind = slope * parameters_.lag_s;
    const double behind = from.position_m - reading_.position_m - steady_behind;
    const double next_m =
        setpoint_.position_m - steady_behind - behind * std::exp(-h / parameters_.lag_s);
    // A jammed axis that comes free is far behind, and yet no faster than it can be.
    const double most_m = limits_.max_velocity_mps * h;
    reading_.position_m += std::clamp(next_m - reading_.position_m, -most_m, most_m);
    reading_.velocity_mps =
        std::clamp((setpoint_.position_m - reading_.position_m) / parameters_.lag_s,
                   -limits_.max_velocity_mps, limits_.max_velocity_mps);
  }
}

void SimulatedAxisDriver::stop_from(Time now) {
  profile_ = quick_stop(limits_, setpoint_);
  profile_start_ = now;
  mode_ = Setpoint::kProfile;
}

void SimulatedAxisDriver::fail(Time now, DriveFault fault) {
  if (jammed_) setpoint_ = {reading_.position_m, 0.0, 0.0};
  stop_from(now);
  reading_.state = AxisState::kFault;
  reading_.fault = fault;
}

Status SimulatedAxisDriver::refuse_unless_connected() const {
  if (!connected_) return unavailable("no connection to the simulated drive");
  return {};
}

Status SimulatedAxisDriver::read(Time now, Duration) {
  simulate_to(now);
  if (!connected_) return refuse_unless_connected();
  reading_.stamp = now;
  last_contact_ = now;
  const bool standing = std::abs(setpoint_.velocity_mps) < 1e-9 &&
                        std::abs(reading_.following_error_m) < kInPosition_m;
  if (reading_.state == AxisState::kHoming && mode_ == Setpoint::kHoming) {
    if (standing && !reference_missing_ &&
        (now - profile_start_).to_seconds() >= profile_.duration_s()) {
      reading_.homed = true;
      mode_ = Setpoint::kProfile;
      reading_.state = AxisState::kReady;
    } else if (now > homing_deadline_) {
      fail(now, DriveFault::kHomingFailed);
    }
  } else if (reading_.state == AxisState::kReady || reading_.state == AxisState::kMoving) {
    reading_.state = standing ? AxisState::kReady : AxisState::kMoving;
  }
  const bool in_use = reading_.state == AxisState::kReady || reading_.state == AxisState::kMoving ||
                      reading_.state == AxisState::kHoming;
  if (in_use && std::abs(reading_.following_error_m) > parameters_.following_error_limit_m) {
    fail(now, DriveFault::kFollowingError);
  }
  return {};
}

Status SimulatedAxisDriver::write(Time now, Duration period, const AxisCommand& command) {
  if (Status status = refuse_unless_connected(); !status) return status;
  if (command.mode == AxisCommandMode::kNone) return {};
  if (reading_.state != AxisState::kReady && reading_.state != AxisState::kMoving) {
    return unavailable("the simulated drive is not ready");
  }
  if (command.mode == AxisCommandMode::kStop) {
    stop_from(now);
    return {};
  }
  if (!std::isfinite(command.position_m) || !std::isfinite(command.velocity_mps)) {
    return Error{ErrorCode::kInvalidArgument, "the commanded position is not finite"};
  }
  if (command.position_m < limits_.lower_m - kPositionTolerance_m ||
      command.position_m > limits_.upper_m + kPositionTolerance_m) {
    return Error{ErrorCode::kOutOfRange, "the commanded position lies outside the limits"};
  }
  if (command.mode == AxisCommandMode::kProfile) {
    const auto profile = plan_s_curve(limits_, setpoint_, command.position_m);
    if (!profile) return profile.error();
    profile_ = *profile;
    profile_start_ = now;
    mode_ = Setpoint::kProfile;
    return {};
  }
  return start_cyclic(now, period, command);
}

Status SimulatedAxisDriver::start_cyclic(Time now, Duration period, const AxisCommand& command) {
  const double period_s = period.to_seconds();
  if (!(period_s > 0.0)) return Error{ErrorCode::kInvalidArgument, "the period is not positive"};
  const double speed = std::abs(command.position_m - setpoint_.position_m) / period_s;
  if (speed > limits_.max_velocity_mps * 1.001 + kPositionTolerance_m / period_s) {
    fail(now, DriveFault::kFollowingError);
    return Error{ErrorCode::kOutOfRange, "the setpoint jumps faster than the axis can move"};
  }
  cyclic_from_ = setpoint_;
  cyclic_to_ = {command.position_m, command.velocity_mps,
                (command.velocity_mps - setpoint_.velocity_mps) / period_s};
  cyclic_start_ = now;
  cyclic_end_ = now + period;
  mode_ = Setpoint::kCyclic;
  return {};
}

Status SimulatedAxisDriver::enable(Time) {
  if (Status status = refuse_unless_connected(); !status) return status;
  if (reading_.state != AxisState::kDisabled) {
    return unavailable("the simulated drive is enabled, faulted or in emergency stop");
  }
  powered_ = true;
  reading_.powered = true;
  reading_.state = reading_.homed ? AxisState::kReady : AxisState::kHoming;
  return {};
}

Status SimulatedAxisDriver::disable(Time now) {
  if (Status status = refuse_unless_connected(); !status) return status;
  stop_from(now);  // the power goes off once it stands
  powered_ = false;
  if (reading_.state != AxisState::kFault && reading_.state != AxisState::kEmergencyStop) {
    reading_.state = AxisState::kDisabled;
  }
  return {};
}

Status SimulatedAxisDriver::home(Time now) {
  if (Status status = refuse_unless_connected(); !status) return status;
  if (!powered_ || reading_.state == AxisState::kFault ||
      reading_.state == AxisState::kEmergencyStop || reading_.state == AxisState::kMoving) {
    return unavailable("the simulated drive cannot home now");
  }
  if (setpoint_.velocity_mps != 0.0) return unavailable("the simulated axis is still stopping");
  MotionLimits slow = limits_;
  slow.max_velocity_mps = std::min(limits_.max_velocity_mps, parameters_.homing_speed_mps);
  const double reference_m = std::clamp(0.0, limits_.lower_m, limits_.upper_m);
  const auto profile = plan_s_curve(slow, {setpoint_.position_m, 0.0, 0.0}, reference_m);
  if (!profile) return profile.error();
  profile_ = *profile;
  profile_start_ = now;
  mode_ = Setpoint::kHoming;
  homing_deadline_ = now + Duration::seconds(parameters_.homing_timeout_s);
  reading_.homed = false;
  reading_.state = AxisState::kHoming;
  return {};
}

Status SimulatedAxisDriver::emergency_stop(Time now) {
  if (Status status = refuse_unless_connected(); !status) return status;
  if (reading_.state != AxisState::kEmergencyStop) stop_from(now);
  reading_.state = AxisState::kEmergencyStop;
  return {};
}

Status SimulatedAxisDriver::reset(Time now) {
  if (Status status = refuse_unless_connected(); !status) return status;
  if (reading_.state != AxisState::kFault && reading_.state != AxisState::kEmergencyStop) {
    return {};
  }
  if (cause_lasts_) return unavailable("the cause of the fault is still there");
  if ((now - profile_start_).to_seconds() < profile_.duration_s()) {
    return unavailable("the simulated axis is still stopping");
  }
  powered_ = false;
  reading_.state = AxisState::kDisabled;
  reading_.fault = DriveFault::kNone;
  return {};
}

void SimulatedAxisDriver::inject(Time now, DriveFault fault) {
  cause_lasts_ = fault != DriveFault::kNone;
  if (cause_lasts_) fail(now, fault);
}

void SimulatedAxisDriver::set_connected(Time now, bool connected) {
  if (connected_ && !connected) fail(now, DriveFault::kConnectionLost);
  connected_ = connected;
}

}  // namespace furrow::actuation
