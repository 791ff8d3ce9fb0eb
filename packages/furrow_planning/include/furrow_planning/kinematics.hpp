#pragma once

#include <cstdint>

#include "furrow_planning/parameters.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

enum class Kinematics : std::uint8_t {
  kVelocity,   ///< the axis moves at its greatest velocity at once (the paper's)
  kTrapezoid,  ///< rest to rest within the limits of velocity and acceleration
};

/// Time in s for an axis to move by `distance_m` (its sign does not matter).
[[nodiscard]] double move_time_s(Kinematics kinematics, double distance_m, double velocity_mps,
                                 double acceleration_mps2);

/// P_ij as a predicate: a head can reach a target `dx_m` ahead and `dy_m` aside (Ahmadi et al.
/// 2024, eq. weedingProb): gamma / theta < dx / dy.
[[nodiscard]] bool can_reach(double dx_m, double dy_m, double speed_mps, double velocity_mps);

/// S_jk in s (eq. favorability): the time that is left of the robot's way between two targets after
/// the axis has moved from one to the other.
[[nodiscard]] double favorability_s(double dx_m, double dy_m, double speed_mps,
                                    double velocity_mps);

/// Gamma_jk in (0, 1) (eq. logisticFunc).
[[nodiscard]] double feasibility(double favorability_s, double omega);

/// The smallest S_jk with Gamma_jk >= rho: ln(rho / (1 - rho)) / omega. @pre 0 < rho < 1, omega >
/// 0.
[[nodiscard]] double cutoff_s(double rho, double omega);

/// Which stops can follow each other on an axis. Stop k can follow stop j when
///   (x_k - x_j) / speed >= margin + move time(|y_k - y_j|).
/// With margin >= 0 this is a partial order under both kinematics: the move time is zero at zero,
/// does not decrease, and is concave, hence subadditive.
class Transition {
 public:
  Transition() = default;
  /// Throws ConfigError when a parameter or limit is out of its range.
  Transition(const PlannerParameters& parameters, double speed_mps, const AxisSpec& axis);

  /// Between two sprays: cutoff + dwell + settle.
  [[nodiscard]] double margin_s() const { return margin_s_; }
  /// From rest to a first spray: half the dwell, settle and the cutoff.
  [[nodiscard]] double first_margin_s() const { return first_margin_s_; }
  [[nodiscard]] double move_s(double dy_m) const;
  /// Way of the robot in m that a move of the axis and the margin take.
  [[nodiscard]] double needed_dx_m(double dy_m) const {
    return speed_mps_ * (margin_s_ + move_s(dy_m));
  }
  [[nodiscard]] double first_dx_m(double dy_m) const {
    return speed_mps_ * (first_margin_s_ + move_s(dy_m));
  }
  [[nodiscard]] bool feasible(double dx_m, double dy_m) const {
    return dx_m >= needed_dx_m(dy_m) - kSlack_m;
  }
  [[nodiscard]] bool first_feasible(double dx_m, double dy_m) const {
    return dx_m >= first_dx_m(dy_m) - kSlack_m;
  }
  [[nodiscard]] Kinematics kinematics() const { return kinematics_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] double velocity_mps() const { return velocity_mps_; }
  [[nodiscard]] double acceleration_mps2() const { return acceleration_mps2_; }
  bool operator==(const Transition&) const = default;

  /// Rounding that is forgiven, so that a plan stays feasible when the frame's origin moves.
  static constexpr double kSlack_m = 1e-9;

 private:
  Kinematics kinematics_ = Kinematics::kVelocity;
  double speed_mps_ = 0.5;
  double velocity_mps_ = 5.0;
  double acceleration_mps2_ = 50.0;
  double margin_s_ = 0.0;
  double first_margin_s_ = 0.0;
};

}  // namespace furrow::planning
