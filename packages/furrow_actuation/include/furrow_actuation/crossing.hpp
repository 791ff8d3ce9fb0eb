#pragma once

#include <Eigen/Core>
#include <optional>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_geometry/tool_model.hpp"

namespace furrow::actuation {

/// Planar velocity of the base in the base frame B.
using geometry::Twist2;

/// Where the base is and how it moves, as the localization says it.
struct BaseState {
  Time stamp;
  geometry::Pose2 X_FB;
  Twist2 twist_B;
};

/// The base's state at another time, at constant twist (an arc).
[[nodiscard]] BaseState extrapolate(const BaseState& base, Time time);

/// The seconds that a droplet falls from `height_m`, leaving downwards at `exit_speed_mps`, without
/// drag: h = u t + g t^2 / 2.
[[nodiscard]] double fall_time_s(double height_m, double exit_speed_mps);

/// The flight of the droplets. A droplet leaves with the nozzle's velocity over ground and keeps
/// the fraction `carry` of it: it lands at p_FN(emission) + carry * fall_s * v_FN(emission).
struct DropletModel {
  double fall_s = 0.0;
  double carry = 1.0;
};

/// The velocity of the nozzle over ground, in F.
[[nodiscard]] Eigen::Vector2d nozzle_velocity(const BaseState& base,
                                              const geometry::AxisModel& axis, double q_m,
                                              double q_velocity_mps);
/// Where droplets land that leave the nozzle now: `base` at the time of emission, axis at q.
[[nodiscard]] Eigen::Vector2d landing_point(const BaseState& base, const geometry::AxisModel& axis,
                                            const DropletModel& droplet, double q_m,
                                            double q_velocity_mps);

/// When droplets must leave the nozzle, and from which axis position, to land on a target.
struct Crossing {
  Time emission;
  Time landing;                    ///< emission + fall
  double q_m = 0.0;                ///< axis position at emission; may lie outside the axis' limits
  double closing_speed_mps = 0.0;  ///< how fast the target nears the axis' line at emission, > 0
};

struct CrossingParameters {
  double min_speed_mps = 0.03;
  double horizon_s = 20.0;

  void visit(ParameterVisitor& v);
};

/// The crossing of a target `p_F` at constant twist; recomputed whenever newer odometry is there.
/// `q_velocity_mps`: the axis' velocity at emission (0: it stands still). The crossing may lie
/// before base.stamp: the target has passed.
/// Fails: kInvalidArgument (not finite), kNoSolution (the robot stands or reverses, the target
/// nears slower than min_speed_mps, or the crossing lies beyond the horizon).
[[nodiscard]] Result<Crossing> predict_crossing(const BaseState& base,
                                                const geometry::AxisModel& axis,
                                                const DropletModel& droplet,
                                                const Eigen::Vector2d& p_F, double q_velocity_mps,
                                                const CrossingParameters& parameters);

/// The same without an Error, for loops that must not allocate. @pre all numbers are finite.
[[nodiscard]] std::optional<Crossing> find_crossing(
    const BaseState& base, const geometry::AxisModel& axis, const DropletModel& droplet,
    const Eigen::Vector2d& p_F, double q_velocity_mps, const CrossingParameters& parameters);

}  // namespace furrow::actuation
