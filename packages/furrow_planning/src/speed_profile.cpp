#include "furrow_planning/speed_profile.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::planning {
namespace {

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

SpeedProfile::SpeedProfile(double from_x_m, double step_m, std::vector<double> speeds_mps)
    : from_x_m_(from_x_m), step_m_(step_m), speeds_mps_(std::move(speeds_mps)) {
  if (!std::isfinite(from_x_m) || !positive(step_m) || speeds_mps_.empty() ||
      !std::ranges::all_of(speeds_mps_, positive)) {
    throw ConfigError("a speed profile needs positive speeds at positive steps");
  }
  greatest_mps_ = std::ranges::max(speeds_mps_);
  times_s_.reserve(speeds_mps_.size());
  times_s_.push_back(0.0);
  for (std::size_t i = 1; i < speeds_mps_.size(); ++i) {
    // Exact for a constant acceleration.
    times_s_.push_back(times_s_.back() + 2.0 * step_m_ / (speeds_mps_[i - 1] + speeds_mps_[i]));
  }
}

SpeedProfile SpeedProfile::constant(double speed_mps) {
  return {0.0, 1.0, {speed_mps}};
}

double SpeedProfile::speed_mps(double x_m) const {
  const double steps = (x_m - from_x_m_) / step_m_;
  if (!(steps > 0.0)) return speeds_mps_.front();
  const double whole = std::floor(steps);
  if (whole + 1.0 >= static_cast<double>(speeds_mps_.size())) return speeds_mps_.back();
  const auto i = static_cast<std::size_t>(whole);
  return std::lerp(speeds_mps_[i], speeds_mps_[i + 1], steps - whole);
}

double SpeedProfile::time_s(double x_m) const {
  const double way_m = x_m - from_x_m_;
  if (way_m <= 0.0) return way_m / speeds_mps_.front();
  const double steps = way_m / step_m_;
  const double whole = std::floor(steps);
  const auto last = static_cast<double>(speeds_mps_.size() - 1);
  if (whole >= last) return times_s_.back() + (way_m - last * step_m_) / speeds_mps_.back();
  const auto i = static_cast<std::size_t>(whole);
  return std::lerp(times_s_[i], times_s_[i + 1], steps - whole);
}

double SpeedProfile::x_m(double time_s) const {
  if (time_s <= 0.0) return from_x_m_ + time_s * speeds_mps_.front();
  const auto after = std::ranges::upper_bound(times_s_, time_s);
  const auto i = static_cast<std::size_t>(after - times_s_.begin()) - 1;
  const double start_m = from_x_m_ + static_cast<double>(i) * step_m_;
  if (after == times_s_.end()) return start_m + (time_s - times_s_[i]) * speeds_mps_.back();
  return start_m + step_m_ * (time_s - times_s_[i]) / (times_s_[i + 1] - times_s_[i]);
}

}  // namespace furrow::planning
