#pragma once

#include <vector>

namespace furrow::planning {

/// Speed of the robot along the row: positive speeds at equal steps of its x, linear between them,
/// constant before the first and after the last.
class SpeedProfile {
 public:
  /// Throws ConfigError when a number is not finite, the step or a speed is not positive, or there
  /// is no speed.
  SpeedProfile(double from_x_m, double step_m, std::vector<double> speeds_mps);
  [[nodiscard]] static SpeedProfile constant(double speed_mps);

  [[nodiscard]] double speed_mps(double x_m) const;
  /// When the robot is at `x_m`, counted from its passing `from_x_m`; ascends with x.
  [[nodiscard]] double time_s(double x_m) const;
  /// Where the robot is then: the inverse of time_s().
  [[nodiscard]] double x_m(double time_s) const;
  [[nodiscard]] double greatest_mps() const { return greatest_mps_; }

 private:
  double from_x_m_;
  double step_m_;
  std::vector<double> speeds_mps_;
  std::vector<double> times_s_;  ///< at the steps
  double greatest_mps_ = 0.0;
};

}  // namespace furrow::planning
