#include "furrow_localization/standstill_detector.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::localization {
namespace {

constexpr std::size_t kMostSamples = 4096;
constexpr double kReleaseWindow_s = 0.05;
/// A single speed this many times the greatest mean is motion.
constexpr double kSingleFactor = 10.0;

}  // namespace

void StandstillParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "window_s",
           .unit = "s",
           .description = "how long wheels and yaw rate must be still",
           .min = 0.05,
           .max = 10.0},
          window_s);
  v.visit({.name = "max_speed_mps",
           .unit = "m/s",
           .description = "greatest mean speed of a robot that stands",
           .min = 0.0001,
           .max = 1.0},
          max_speed_mps);
  v.visit({.name = "max_yaw_rate_radps",
           .unit = "rad/s",
           .description = "greatest mean yaw rate of a robot that stands, the gyroscope's bias "
                          "included",
           .min = 0.0001,
           .max = 1.0},
          max_yaw_rate_radps);
  v.visit({.name = "release_speed_mps",
           .unit = "m/s",
           .description = "speed that ends a standstill",
           .min = 0.0001,
           .max = 1.0},
          release_speed_mps);
  v.visit({.name = "release_yaw_rate_radps",
           .unit = "rad/s",
           .description = "yaw rate that ends a standstill",
           .min = 0.0001,
           .max = 1.0},
          release_yaw_rate_radps);
  v.visit({.name = "max_creep_m",
           .unit = "m",
           .description = "way of the wheels that ends a standstill however slow it was",
           .min = 0.001,
           .max = 1.0},
          max_creep_m);
}

bool StandstillDetector::Window::add(const Sample& sample, double length_s) {
  if (!std::isfinite(sample.value)) return false;
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return false;
  samples_.push_back(sample);
  while (samples_.size() > kMostSamples ||
         (sample.stamp - samples_.front().stamp).to_seconds() > length_s) {
    samples_.pop_front();
  }
  return true;
}

bool StandstillDetector::Window::full(double length_s) const {
  constexpr double kShare = 0.8;
  return samples_.size() > 2 &&
         (samples_.back().stamp - samples_.front().stamp).to_seconds() >= kShare * length_s;
}

double StandstillDetector::Window::mean(double newest_s) const {
  double sum = 0.0;
  int count = 0;
  for (auto it = samples_.rbegin(); it != samples_.rend(); ++it) {
    if ((samples_.back().stamp - it->stamp).to_seconds() > newest_s) break;
    sum += it->value;
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

double StandstillDetector::Window::greatest() const {
  double greatest = 0.0;
  for (const Sample& sample : samples_) greatest = std::max(greatest, std::abs(sample.value));
  return greatest;
}

StandstillDetector::StandstillDetector(const StandstillParameters& parameters)
    : parameters_(parameters) {
  validate_parameters(parameters_);
}

void StandstillDetector::add_wheels(Time stamp, double speed_mps, double yaw_rate_radps) {
  const auto& known = speeds_.samples();
  const double since_s = known.empty() ? 0.0 : (stamp - known.back().stamp).to_seconds();
  if (!speeds_.add({stamp, speed_mps}, parameters_.window_s)) return;
  (void)wheel_yaw_rates_.add({stamp, yaw_rate_radps}, parameters_.window_s);
  if (standing_) crept_m_ += speed_mps * std::min(since_s, parameters_.window_s);
  judge();
}

void StandstillDetector::add_gyroscope(Time stamp, double yaw_rate_radps) {
  if (gyroscope_.add({stamp, yaw_rate_radps}, parameters_.window_s)) judge();
}

const StandstillDetector::Window& StandstillDetector::yaw_rates() const {
  const bool comes =
      gyroscope_.full(parameters_.window_s) && !speeds_.samples().empty() &&
      std::abs((speeds_.samples().back().stamp - gyroscope_.samples().back().stamp).to_seconds()) <
          parameters_.window_s;
  return comes ? gyroscope_ : wheel_yaw_rates_;
}

void StandstillDetector::judge() {
  if (standing_) {
    const bool drives = std::abs(speeds_.mean(kReleaseWindow_s)) > parameters_.release_speed_mps;
    const bool turns =
        std::abs(yaw_rates().mean(kReleaseWindow_s)) > parameters_.release_yaw_rate_radps;
    if (!drives && !turns && std::abs(crept_m_) <= parameters_.max_creep_m) return;
    standing_ = false;
    speeds_.clear();
    wheel_yaw_rates_.clear();
    return;
  }
  standing_ = speeds_.full(parameters_.window_s) &&
              std::abs(speeds_.mean(parameters_.window_s)) <= parameters_.max_speed_mps &&
              speeds_.greatest() <= kSingleFactor * parameters_.max_speed_mps &&
              std::abs(yaw_rates().mean(parameters_.window_s)) <= parameters_.max_yaw_rate_radps;
  crept_m_ = 0.0;
}

}  // namespace furrow::localization
