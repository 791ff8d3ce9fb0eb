#include "furrow_planning/kinematics.hpp"

#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::planning {
namespace {

void require(bool condition, std::string_view message) {
  if (!condition) {
    throw ConfigError(message);
  }
}

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

double move_time_s(Kinematics kinematics, double distance_m, double velocity_mps,
                   double acceleration_mps2) {
  const double d = std::abs(distance_m);
  if (kinematics == Kinematics::kVelocity) {
    return d / velocity_mps;
  }
  const double ramps_m = velocity_mps * velocity_mps / acceleration_mps2;
  return d >= ramps_m ? d / velocity_mps + velocity_mps / acceleration_mps2
                      : 2.0 * std::sqrt(d / acceleration_mps2);
}

bool can_reach(double dx_m, double dy_m, double speed_mps, double velocity_mps) {
  return dx_m > 0.0 && speed_mps * std::abs(dy_m) < velocity_mps * dx_m;
}

double favorability_s(double dx_m, double dy_m, double speed_mps, double velocity_mps) {
  return dx_m / speed_mps - std::abs(dy_m) / velocity_mps;
}

double feasibility(double favorability_s, double omega) {
  return 1.0 / (1.0 + std::exp(-omega * favorability_s));
}

double cutoff_s(double rho, double omega) {
  return std::log(rho / (1.0 - rho)) / omega;
}

Transition::Transition(const PlannerParameters& parameters, double speed_mps, const AxisSpec& axis)
    : kinematics_(parameters.kinematics == "trapezoid" ? Kinematics::kTrapezoid
                                                       : Kinematics::kVelocity),
      speed_mps_(speed_mps),
      velocity_mps_(axis.max_velocity_mps),
      acceleration_mps2_(axis.max_acceleration_mps2) {
  require(parameters.kinematics == "velocity" || parameters.kinematics == "trapezoid",
          "kinematics is neither velocity nor trapezoid");
  require(parameters.rho >= 0.5 && parameters.rho < 1.0, "rho is not in [0.5, 1)");
  require(positive(parameters.omega), "omega is not positive");
  require(parameters.dwell_s >= 0.0 && std::isfinite(parameters.dwell_s), "dwell_s is negative");
  require(parameters.settle_s >= 0.0 && std::isfinite(parameters.settle_s), "settle_s is negative");
  require(positive(speed_mps), "the robot's speed is not positive");
  require(positive(velocity_mps_), "an axis's velocity limit is not positive");
  require(positive(acceleration_mps2_), "an axis's acceleration limit is not positive");
  const double common_s = cutoff_s(parameters.rho, parameters.omega) + parameters.settle_s;
  margin_s_ = common_s + parameters.dwell_s;
  first_margin_s_ = common_s + 0.5 * parameters.dwell_s;
}

double Transition::move_s(double dy_m) const {
  return move_time_s(kinematics_, dy_m, velocity_mps_, acceleration_mps2_);
}

}  // namespace furrow::planning
