#pragma once

#include <deque>

#include "furrow_core/parameters.hpp"
#include "furrow_core/time.hpp"

namespace furrow::localization {

struct StandstillParameters {
  double window_s = 0.3;
  double max_speed_mps = 0.005;
  double max_yaw_rate_radps = 0.01;
  double release_speed_mps = 0.02;
  double release_yaw_rate_radps = 0.05;
  double max_creep_m = 0.03;

  void visit(ParameterVisitor& v);
};

/// Detects that the robot stands. Over a window the means of the wheels' speed and of the yaw rate
/// are within their noise of zero, and no single speed is far from it. This is zero-velocity
/// detection as in Skog, Handel, Nilsson and Rantakokko 2010, on means instead of energies. Driving
/// on ends it within some 50 ms; so does creeping by more than max_creep_m. Measurements of the
/// gyroscope replace the wheels' yaw rate while they come. Bounded memory.
class StandstillDetector {
 public:
  /// Throws ConfigError when a parameter is out of its range.
  explicit StandstillDetector(const StandstillParameters& parameters = {});

  /// Measurements that are not finite or not newer than the last are left out.
  void add_wheels(Time stamp, double speed_mps, double yaw_rate_radps);
  void add_gyroscope(Time stamp, double yaw_rate_radps);

  [[nodiscard]] bool standing() const { return standing_; }

 private:
  struct Sample {
    Time stamp;
    double value = 0.0;
  };
  /// The newest measurements of one sensor.
  class Window {
   public:
    bool add(const Sample& sample, double length_s);
    [[nodiscard]] bool full(double length_s) const;
    [[nodiscard]] double mean(double newest_s) const;
    [[nodiscard]] double greatest() const;
    [[nodiscard]] const std::deque<Sample>& samples() const { return samples_; }
    void clear() { samples_.clear(); }

   private:
    std::deque<Sample> samples_;
  };

  void judge();
  [[nodiscard]] const Window& yaw_rates() const;

  StandstillParameters parameters_;
  Window speeds_;
  Window wheel_yaw_rates_;
  Window gyroscope_;
  double crept_m_ = 0.0;
  bool standing_ = false;
};

}  // namespace furrow::localization
