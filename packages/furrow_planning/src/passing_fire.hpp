#pragma once

#include <Eigen/Core>
#include <optional>

#include "prepared_problem.hpp"

namespace furrow::planning {

/// A move of an axis from rest to rest between two places on the ground (F).
struct Leg {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double dwell_after_from_m = 0.0;  ///< way of the robot before the axis may leave `from`
};

struct PassingSpray {
  Eigen::Vector2d aim = Eigen::Vector2d::Zero();
  double departure_m = 0.0;  ///< way of the robot from the departure to the spray
};

/// Time from the departure of a move of `whole_m` until it has gone `part_m`.
[[nodiscard]] double time_to_part_s(const Transition& transition, double part_m, double whole_m);

/// A spray that the nozzle fires during the leg, as near to the stem as possible and within
/// `radius_m`. The departure keeps the margin of arrival. Empty when there is no such spray.
[[nodiscard]] std::optional<PassingSpray> passing_spray(const Transition& transition,
                                                        const Leg& leg, const Eigen::Vector2d& stem,
                                                        double radius_m);

}  // namespace furrow::planning
