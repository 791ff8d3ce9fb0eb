#include "furrow_actuation/motion_profile.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::actuation {
namespace {

MotionState advance(const MotionState& from, double jerk, double t) {
  return {from.position_m +
              t * (from.velocity_mps + t * (from.acceleration_mps2 / 2.0 + t * jerk / 6.0)),
          from.velocity_mps + t * (from.acceleration_mps2 + t * jerk / 2.0),
          from.acceleration_mps2 + t * jerk};
}

}  // namespace

MotionLimits MotionLimits::of(const geometry::AxisModel& axis) {
  return {axis.lower_m, axis.upper_m, axis.max_velocity_mps, axis.max_acceleration_mps2,
          axis.max_jerk_mps3};
}

MotionProfile MotionProfile::standing(double position_m) {
  return MotionProfile(MotionState{position_m, 0.0, 0.0});
}

MotionState MotionProfile::at(double t_s) const {
  if (t_s >= duration_s_) return final_;
  if (!(t_s > 0.0) || segments_.empty()) return first_;
  std::size_t i = segments_.size() - 1;
  while (i > 0 && segments_[i].start_s > t_s) --i;
  return advance(segments_[i].start, segments_[i].jerk_mps3, t_s - segments_[i].start_s);
}

void MotionProfile::append(double duration_s, double jerk_mps3) {
  if (!(duration_s > 0.0)) return;
  segments_.push_back({duration_s_, final_, jerk_mps3});
  final_ = advance(final_, jerk_mps3, duration_s);
  duration_s_ += duration_s;
}

void MotionProfile::append_acceleration(double duration_s, double acceleration_mps2) {
  final_.acceleration_mps2 = acceleration_mps2;
  append(duration_s, 0.0);
}

MotionProfile::Range MotionProfile::position_range() const {
  Range range{std::min(first_.position_m, final_.position_m),
              std::max(first_.position_m, final_.position_m)};
  const auto include = [&](double position) {
    range.min_m = std::min(range.min_m, position);
    range.max_m = std::max(range.max_m, position);
  };
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    const double end_s = i + 1 < segments_.size() ? segments_[i + 1].start_s : duration_s_;
    include(s.start.position_m);
    // Extremes stand where v + a t + j t^2 / 2 = 0.
    const double v = s.start.velocity_mps;
    const double a = s.start.acceleration_mps2;
    const double discriminant = a * a - 2.0 * s.jerk_mps3 * v;
    if (discriminant < 0.0) continue;
    // The form that does not cancel; both roots, also when the jerk is zero.
    const double q = -(a + std::copysign(std::sqrt(discriminant), a));
    for (const double t : {q / s.jerk_mps3, 2.0 * v / q}) {
      if (std::isfinite(t) && t > 0.0 && t < end_s - s.start_s) {
        include(advance(s.start, s.jerk_mps3, t).position_m);
      }
    }
  }
  return range;
}

double MotionProfile::peak_speed_mps() const {
  double peak = std::max(std::abs(first_.velocity_mps), std::abs(final_.velocity_mps));
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    peak = std::max(peak, std::abs(s.start.velocity_mps));
    const double end_s = i + 1 < segments_.size() ? segments_[i + 1].start_s : duration_s_;
    const double t = s.jerk_mps3 != 0.0 ? -s.start.acceleration_mps2 / s.jerk_mps3 : -1.0;
    if (t > 0.0 && t < end_s - s.start_s) {
      peak = std::max(peak, std::abs(advance(s.start, s.jerk_mps3, t).velocity_mps));
    }
  }
  return peak;
}

}  // namespace furrow::actuation
