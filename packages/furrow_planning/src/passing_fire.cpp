#include "passing_fire.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::planning {
namespace {

constexpr double kLeastMove_m = 1e-3;
constexpr double kInside = 0.999;

}  // namespace

double time_to_part_s(const Transition& transition, double part_m, double whole_m) {
  if (transition.kinematics() == Kinematics::kVelocity) {
    return part_m / transition.velocity_mps();
  }
  if (part_m > 0.5 * whole_m) {
    return transition.move_s(whole_m) - time_to_part_s(transition, whole_m - part_m, whole_m);
  }
  // The first half: the ramp, and what remains at the peak velocity.
  const double a = transition.acceleration_mps2();
  const double peak = std::min(transition.velocity_mps(), std::sqrt(a * whole_m));
  const double ramp_m = 0.5 * peak * peak / a;
  return part_m <= ramp_m ? std::sqrt(2.0 * part_m / a) : peak / a + (part_m - ramp_m) / peak;
}

std::optional<PassingSpray> passing_spray(const Transition& transition, const Leg& leg,
                                          const Eigen::Vector2d& stem, double radius_m) {
  const double whole_m = std::abs(leg.to.y() - leg.from.y());
  if (whole_m < kLeastMove_m) {
    return std::nullopt;
  }
  const double y_m =
      std::clamp(stem.y(), std::min(leg.from.y(), leg.to.y()), std::max(leg.from.y(), leg.to.y()));
  const double aside_m = y_m - stem.y();
  const double reach_m = kInside * radius_m;
  if (std::abs(aside_m) > reach_m) {
    return std::nullopt;
  }
  const double along_m = std::sqrt(reach_m * reach_m - aside_m * aside_m);
  const double way_m =
      transition.speed_mps() * time_to_part_s(transition, std::abs(y_m - leg.from.y()), whole_m);
  const double earliest_m = leg.from.x() + leg.dwell_after_from_m + way_m;
  const double latest_m = leg.to.x() - transition.first_dx_m(whole_m) + way_m;
  const double x_m = std::clamp(stem.x(), earliest_m, std::max(earliest_m, latest_m));
  if (earliest_m > latest_m || std::abs(x_m - stem.x()) > along_m) {
    return std::nullopt;
  }
  return PassingSpray{.aim = {x_m, y_m}, .departure_m = way_m};
}

}  // namespace furrow::planning
