#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "furrow_actuation/crossing.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/tool_model.hpp"

namespace furrow::actuation::campaign {

inline constexpr Duration kCycle = Duration::milliseconds(2);

struct TruePlant {
  std::int64_t id = 0;
  bool crop = false;
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
};

/// A robot that drives a row: it starts at speed, and may stand or reverse once.
struct Journey {
  double speed_mps = 0.5;
  double pause_at_s = 1e9;
  double pause_s = 0.0;
  double back_s = 0.0;  ///< of the pause, driven backwards at kBack_mps first
  static constexpr double kBack_mps = 0.2;
  static constexpr double kAcceleration_mps2 = 1.0;
};

/// The ground truth: the field and where the robot truly is.
class World {
 public:
  World(Random& random, Journey journey);

  /// One cycle on.
  void advance();
  [[nodiscard]] Time now() const { return base_.stamp; }
  [[nodiscard]] const BaseState& base() const { return base_; }
  [[nodiscard]] const std::vector<TruePlant>& plants() const { return plants_; }

 private:
  [[nodiscard]] double commanded_mps(double t_s) const;

  Journey journey_;
  std::vector<TruePlant> plants_;
  BaseState base_;
};

/// The axis of the paper's robot with this index.
[[nodiscard]] geometry::AxisModel axis_model(int index);

/// Where a drop lands that leaves a nozzle now; independent of the controller's own prediction but
/// for the same physics.
[[nodiscard]] Eigen::Vector2d drop_landing(const BaseState& base, const geometry::AxisModel& axis,
                                           double q_m, double q_velocity_mps);

}  // namespace furrow::actuation::campaign
