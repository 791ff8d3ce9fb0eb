#include "furrow_experiments/audit.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "furrow_planning/kinematics.hpp"

namespace furrow::experiments {
namespace {

constexpr double kRounding_m = 1e-6;

std::string place(const Eigen::Vector2d& p_F) {
  return "(" + std::to_string(p_F.x()) + ", " + std::to_string(p_F.y()) + ")";
}

Error broken(const Spray& spray, const std::string& what) {
  return {ErrorCode::kNoSolution, "the spray of axis " + std::to_string(spray.axis) + " at " +
                                      place(spray.aim_F) + " " + what};
}

Status check_weeds(const FieldTargets& field, const Spray& spray, double radius_m,
                   std::vector<bool>& treated) {
  for (const planning::TargetId id : spray.treated) {
    const auto weed = static_cast<std::size_t>(id);
    if (weed >= field.weeds.size()) return broken(spray, "treats a weed that is not there");
    if (treated[weed]) return broken(spray, "treats a weed again");
    treated[weed] = true;
    if ((field.weeds[weed].p_F - spray.aim_F).norm() > radius_m + kRounding_m) {
      return broken(spray, "does not reach its weed at " + place(field.weeds[weed].p_F));
    }
  }
  return {};
}

Status check_crops(const FieldTargets& field, const Spray& spray, double radius_m, double zone_m) {
  double widest_m = 0.0;
  for (const auto& crop : field.crops) widest_m = std::max(widest_m, crop.zone_m);
  const double far_m = radius_m + zone_m + widest_m;
  const auto first = std::lower_bound(
      field.crops.begin(), field.crops.end(), spray.aim_F.x() - far_m,
      [](const planning::ProtectedPlant& crop, double x_m) { return crop.p_F.x() < x_m; });
  for (auto crop = first; crop != field.crops.end() && crop->p_F.x() <= spray.aim_F.x() + far_m;
       ++crop) {
    if ((crop->p_F - spray.aim_F).norm() < radius_m + zone_m + crop->zone_m - kRounding_m) {
      return broken(spray, "enters the protection zone of the crop at " + place(crop->p_F));
    }
  }
  return {};
}

}  // namespace

Status check_sprays(const FieldTargets& field, std::span<const Spray> sprays,
                    const planning::PlannerParameters& planner, const SetupParameters& setup) {
  const auto kinematics = planner.kinematics == "trapezoid" ? planning::Kinematics::kTrapezoid
                                                            : planning::Kinematics::kVelocity;
  const double wait_s = planner.fire_while_moving ? 0.0
                                                  : planning::cutoff_s(planner.rho, planner.omega) +
                                                        planner.dwell_s + planner.settle_s;
  const double half_span_m = 0.5 * setup.axis_travel_m;
  std::vector<bool> treated(field.weeds.size(), false);
  for (std::size_t i = 0; i < sprays.size(); ++i) {
    const Spray& spray = sprays[i];
    if (spray.axis >= static_cast<std::size_t>(setup.axes)) {
      return broken(spray, "has no such axis");
    }
    if (std::abs(spray.aim_F.y()) > half_span_m + kRounding_m) {
      return broken(spray, "lies beyond the span");
    }
    if (Status status = check_weeds(field, spray, planner.footprint_radius_m, treated);
        !status.ok()) {
      return status;
    }
    if (Status status = check_crops(field, spray, planner.footprint_radius_m,
                                    1e-3 * planner.protection_zone_mm);
        !status.ok()) {
      return status;
    }
    if (i == 0 || sprays[i - 1].axis != spray.axis) continue;
    const Eigen::Vector2d way = spray.aim_F - sprays[i - 1].aim_F;
    const double needed_s =
        wait_s + planning::move_time_s(kinematics, way.y(), setup.axis_velocity_mps,
                                       setup.axis_acceleration_mps2);
    if (way.x() < planner.speed_mps * needed_s - kRounding_m) {
      return broken(spray, "follows too soon on the one before");
    }
  }
  return {};
}

}  // namespace furrow::experiments
