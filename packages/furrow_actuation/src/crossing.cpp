#include "furrow_actuation/crossing.hpp"

#include <cmath>

namespace furrow::actuation {
namespace {

constexpr double kGravity_mps2 = 9.80665;

/// The velocity over ground, in B, of a point fixed to the base.
Eigen::Vector2d point_velocity(const Twist2& twist, const Eigen::Vector2d& p_B) {
  return {twist.vx_mps - twist.yaw_rate_radps * p_B.y(),
          twist.vy_mps + twist.yaw_rate_radps * p_B.x()};
}

Eigen::Vector2d rotate(double heading_rad, const Eigen::Vector2d& v) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace

BaseState extrapolate(const BaseState& base, Time time) {
  const double dt_s = (time - base.stamp).to_seconds();
  return {time, geometry::extrapolate(base.X_FB, base.twist_B, dt_s), base.twist_B};
}

double fall_time_s(double height_m, double exit_speed_mps) {
  const double u = exit_speed_mps;
  return (std::sqrt(u * u + 2.0 * kGravity_mps2 * height_m) - u) / kGravity_mps2;
}

Eigen::Vector2d nozzle_velocity(const BaseState& base, const geometry::AxisModel& axis, double q_m,
                                double q_velocity_mps) {
  const Eigen::Vector2d p_B = axis.nozzle_position_B(q_m).head<2>();
  return rotate(base.X_FB.heading_rad,
                point_velocity(base.twist_B, p_B) + q_velocity_mps * axis.direction_B.head<2>());
}

Eigen::Vector2d landing_point(const BaseState& base, const geometry::AxisModel& axis,
                              const DropletModel& droplet, double q_m, double q_velocity_mps) {
  return geometry::transform(base.X_FB, axis.nozzle_position_B(q_m).head<2>()) +
         droplet.carry * droplet.fall_s * nozzle_velocity(base, axis, q_m, q_velocity_mps);
}

std::optional<Crossing> find_crossing(const BaseState& base, const geometry::AxisModel& axis,
                                      const DropletModel& droplet, const Eigen::Vector2d& p_F,
                                      double q_velocity_mps, const CrossingParameters& parameters) {
  if (!(base.twist_B.vx_mps >= parameters.min_speed_mps)) return std::nullopt;
  const Eigen::Vector2d direction = axis.direction_B.head<2>();
  Eigen::Vector2d normal(direction.y(), -direction.x());
  if (normal.x() < 0.0) normal = -normal;
  const Eigen::Vector2d p_BN0 = axis.p_BN0.head<2>();
  const double flight_s = droplet.carry * droplet.fall_s;

  double dt = 0.0;
  Crossing crossing;
  constexpr int kMaxIterations = 20;
  for (int i = 0; i < kMaxIterations; ++i) {
    const BaseState at = extrapolate(base, base.stamp + Duration::seconds(dt));
    const Eigen::Vector2d p_B = geometry::transform(geometry::inverse(at.X_FB), p_F);
    crossing.q_m = direction.dot(p_B - p_BN0 - flight_s * point_velocity(at.twist_B, p_BN0)) /
                       direction.squaredNorm() -
                   flight_s * q_velocity_mps;
    const Eigen::Vector2d nozzle_B = p_BN0 + crossing.q_m * direction;
    const Eigen::Vector2d velocity_B = point_velocity(at.twist_B, nozzle_B);
    crossing.closing_speed_mps = normal.dot(velocity_B);
    if (!(crossing.closing_speed_mps >= parameters.min_speed_mps)) return std::nullopt;
    const double step =
        normal.dot(p_B - nozzle_B - flight_s * velocity_B) / crossing.closing_speed_mps;
    dt += step;
    if (!(std::abs(dt) <= parameters.horizon_s)) return std::nullopt;
    if (std::abs(step) < 1e-9) {
      crossing.emission = base.stamp + Duration::seconds(dt);
      crossing.landing = crossing.emission + Duration::seconds(droplet.fall_s);
      return crossing;
    }
  }
  return std::nullopt;
}

Result<Crossing> predict_crossing(const BaseState& base, const geometry::AxisModel& axis,
                                  const DropletModel& droplet, const Eigen::Vector2d& p_F,
                                  double q_velocity_mps, const CrossingParameters& parameters) {
  for (const double value :
       {base.X_FB.x_m, base.X_FB.y_m, base.X_FB.heading_rad, base.twist_B.vx_mps,
        base.twist_B.vy_mps, base.twist_B.yaw_rate_radps, p_F.x(), p_F.y(), q_velocity_mps}) {
    if (!std::isfinite(value)) {
      return Error{ErrorCode::kInvalidArgument, "the base's state or the target is not finite"};
    }
  }
  if (const auto crossing = find_crossing(base, axis, droplet, p_F, q_velocity_mps, parameters)) {
    return *crossing;
  }
  if (base.twist_B.vx_mps < parameters.min_speed_mps) {
    return Error{ErrorCode::kNoSolution, "the robot stands or reverses"};
  }
  return Error{ErrorCode::kNoSolution, "the target does not cross the axis within the horizon"};
}

void CrossingParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "min_speed_mps",
           .unit = "m/s",
           .description = "a robot slower than this counts as standing",
           .min = 0.001},
          min_speed_mps);
  v.visit({.name = "horizon_s",
           .unit = "s",
           .description = "crossings farther away in time are not looked at",
           .min = 0.1,
           .max = 600.0},
          horizon_s);
}

}  // namespace furrow::actuation
