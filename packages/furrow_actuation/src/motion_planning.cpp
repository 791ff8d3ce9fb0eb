#include <algorithm>
#include <cmath>

#include "furrow_actuation/motion_profile.hpp"

namespace furrow::actuation {
namespace {

constexpr double kTolerance = 1e-9;

Status check(const MotionLimits& limits, const MotionState& start, double target_m) {
  for (const double value : {limits.lower_m, limits.upper_m, limits.max_velocity_mps,
                             limits.max_acceleration_mps2, limits.max_jerk_mps3, start.position_m,
                             start.velocity_mps, start.acceleration_mps2, target_m}) {
    if (!std::isfinite(value)) {
      return Error{ErrorCode::kInvalidArgument, "a limit, start or target is not finite"};
    }
  }
  if (limits.max_velocity_mps <= 0.0 || limits.max_acceleration_mps2 <= 0.0 ||
      limits.max_jerk_mps3 <= 0.0 || limits.lower_m >= limits.upper_m) {
    return Error{ErrorCode::kInvalidArgument, "the motion limits are not positive or not ordered"};
  }
  if (target_m < limits.lower_m - kTolerance || target_m > limits.upper_m + kTolerance) {
    return Error{ErrorCode::kOutOfRange, "the target lies outside the position limits"};
  }
  if (std::abs(start.velocity_mps) > limits.max_velocity_mps * (1.0 + kTolerance)) {
    return Error{ErrorCode::kOutOfRange, "the start is faster than the velocity limit"};
  }
  return {};
}

bool inside(const MotionProfile::Range& range, const MotionLimits& limits) {
  return range.min_m >= limits.lower_m - kTolerance && range.max_m <= limits.upper_m + kTolerance;
}

Error passes_limit() {
  return {ErrorCode::kNoSolution, "the start cannot brake before a position limit"};
}

/// The velocity that is reached by bringing the acceleration straight to zero.
double direct_velocity(const MotionState& s, double jerk) {
  return s.velocity_mps + s.acceleration_mps2 * std::abs(s.acceleration_mps2) / (2.0 * jerk);
}

/// The quickest way to a velocity with acceleration zero, after what `profile` holds: jerk one way,
/// perhaps constant acceleration, jerk the other way.
void append_velocity_change(MotionProfile& profile, const MotionLimits& limits,
                            double velocity_mps) {
  const double jerk = limits.max_jerk_mps3;
  const double a_max = limits.max_acceleration_mps2;
  const double excess = std::abs(profile.final_state().acceleration_mps2) - a_max;
  if (excess > 0.0) {
    profile.append(excess / jerk, -std::copysign(jerk, profile.final_state().acceleration_mps2));
  }
  const MotionState& from = profile.final_state();
  const double sign = velocity_mps >= direct_velocity(from, jerk) ? 1.0 : -1.0;
  const double a0 = sign * from.acceleration_mps2;
  const double dv = sign * (velocity_mps - from.velocity_mps);
  // (peak^2 - a0^2) / 2j + peak^2 / 2j = dv
  const double peak = std::max(a0, std::sqrt(std::max(0.0, jerk * dv + a0 * a0 / 2.0)));
  if (peak <= a_max) {
    profile.append((peak - a0) / jerk, sign * jerk);
    profile.append(peak / jerk, -sign * jerk);
  } else {
    const double ramps_dv = (2.0 * a_max * a_max - a0 * a0) / (2.0 * jerk);
    profile.append((a_max - a0) / jerk, sign * jerk);
    profile.append((dv - ramps_dv) / a_max, 0.0);
    profile.append(a_max / jerk, -sign * jerk);
  }
  profile.set_final({profile.final_state().position_m, velocity_mps, 0.0});
}

/// Appends the first `duration_s` of another profile that starts in the last state.
void append_part(MotionProfile& profile, const MotionProfile& part, double duration_s) {
  const auto& segments = part.segments();
  for (std::size_t i = 0; i < segments.size() && segments[i].start_s < duration_s; ++i) {
    const double end_s = i + 1 < segments.size() ? segments[i + 1].start_s : part.duration_s();
    profile.append(std::min(end_s, duration_s) - segments[i].start_s, segments[i].jerk_mps3);
  }
  profile.set_final(part.at(duration_s));
}

double stop_position(const MotionLimits& limits, const MotionState& from) {
  MotionProfile stop(from);
  append_velocity_change(stop, limits, 0.0);
  return stop.final_state().position_m;
}

/// The quickest movement to rest at the target without regard to the position limits.
void append_quickest(MotionProfile& profile, const MotionLimits& limits, double target_m) {
  const MotionState start = profile.final_state();
  const double beyond_m = target_m - stop_position(limits, start);
  if (std::abs(beyond_m) < 1e-12) return append_velocity_change(profile, limits, 0.0);
  const double sign = beyond_m > 0.0 ? 1.0 : -1.0;
  MotionProfile fastest(start);
  append_velocity_change(fastest, limits, sign * limits.max_velocity_mps);
  const double rest_m = sign * (target_m - stop_position(limits, fastest.final_state()));
  if (rest_m >= 0.0) {
    append_part(profile, fastest, fastest.duration_s());
    profile.append(rest_m / limits.max_velocity_mps, 0.0);
  } else {
    // The stopping position grows with the instant of leaving the fastest way.
    double low = 0.0;
    double high = fastest.duration_s();
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2.0;
      if (middle <= low || middle >= high) break;
      const double past = sign * (stop_position(limits, fastest.at(middle)) - target_m);
      (past <= 0.0 ? low : high) = middle;
    }
    append_part(profile, fastest, low);
  }
  append_velocity_change(profile, limits, 0.0);
}

/// Brakes away from a passed limit for the shortest time that keeps `finish` inside the limits.
template <class Finish>
bool append_braked(MotionProfile& profile, const MotionLimits& limits, bool passes_upper,
                   const Finish& finish) {
  const MotionState start = profile.final_state();
  MotionProfile away(start);
  append_velocity_change(away, limits, (passes_upper ? -1.0 : 1.0) * limits.max_velocity_mps);
  const auto attempt = [&](double braked_s) {
    MotionProfile candidate(start);
    append_part(candidate, away, braked_s);
    finish(candidate);
    return candidate;
  };
  // Past the instant where the axis turns, braking on keeps the axis from the limit already.
  double low = 0.0;
  double high = 0.0;
  constexpr int kSteps = 32;
  int step = 1;
  for (; step <= kSteps; ++step) {
    high = away.duration_s() * step / kSteps;
    if (inside(attempt(high).position_range(), limits)) break;
    low = high;
  }
  if (step > kSteps) return false;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2.0;
    (inside(attempt(middle).position_range(), limits) ? high : low) = middle;
  }
  profile = attempt(high);
  return true;
}

}  // namespace

Result<MotionProfile> plan_trapezoid(const MotionLimits& limits, const MotionState& start,
                                     double target_m) {
  if (Status status = check(limits, start, target_m); !status) return status.error();
  const double a = limits.max_acceleration_mps2;
  const double v0 = start.velocity_mps;
  const double stop_m = start.position_m + v0 * std::abs(v0) / (2.0 * a);
  const double sign = target_m >= stop_m ? 1.0 : -1.0;
  const double distance = sign * (target_m - start.position_m);
  // (peak^2 - v0^2) / 2a + peak^2 / 2a = distance, unless the velocity limit is met before.
  const double peak =
      std::min(limits.max_velocity_mps, std::sqrt(std::max(0.0, a * distance + v0 * v0 / 2.0)));
  const double ramps = (2.0 * peak * peak - v0 * v0) / (2.0 * a);
  MotionProfile profile({start.position_m, v0, 0.0});
  profile.append_acceleration((peak - sign * v0) / a, sign * a);
  if (peak > 0.0) profile.append_acceleration((distance - ramps) / peak, 0.0);
  profile.append_acceleration(peak / a, -sign * a);
  profile.set_final({target_m, 0.0, 0.0});
  if (!inside(profile.position_range(), limits)) return passes_limit();
  return profile;
}

Result<MotionProfile> plan_s_curve(const MotionLimits& limits, const MotionState& start,
                                   double target_m) {
  if (Status status = check(limits, start, target_m); !status) return status.error();
  if (std::abs(start.acceleration_mps2) > limits.max_acceleration_mps2 * (1.0 + kTolerance)) {
    return Error{ErrorCode::kOutOfRange, "the start exceeds the acceleration limit"};
  }
  if (std::abs(direct_velocity(start, limits.max_jerk_mps3)) >
      limits.max_velocity_mps * (1.0 + kTolerance)) {
    return Error{ErrorCode::kOutOfRange, "the start is bound to exceed the velocity limit"};
  }
  MotionProfile profile(start);
  append_quickest(profile, limits, target_m);
  if (!inside(profile.position_range(), limits)) {
    const bool upper = profile.position_range().max_m > limits.upper_m + kTolerance;
    MotionProfile braked(start);
    if (!append_braked(braked, limits, upper, [&](MotionProfile& candidate) {
          append_quickest(candidate, limits, target_m);
        })) {
      return passes_limit();
    }
    profile = braked;
  }
  profile.set_final({target_m, 0.0, 0.0});
  return profile;
}

MotionProfile plan_stop(const MotionLimits& limits, const MotionState& start) {
  const auto finish = [&](MotionProfile& candidate) {
    append_velocity_change(candidate, limits, 0.0);
  };
  MotionProfile profile(start);
  finish(profile);
  if (!inside(profile.position_range(), limits)) {
    const bool upper = profile.position_range().max_m > limits.upper_m + kTolerance;
    MotionProfile braked(start);
    if (append_braked(braked, limits, upper, finish)) return braked;
  }
  return profile;
}

}  // namespace furrow::actuation
