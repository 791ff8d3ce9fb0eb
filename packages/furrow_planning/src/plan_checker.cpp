#include "furrow_planning/plan_checker.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "furrow_planning/speed_profile.hpp"

namespace furrow::planning {
namespace {

constexpr double kTolerance_m = 1e-6;

Error fault(const std::string& what) {
  return {ErrorCode::kNoSolution, "plan: " + what};
}

std::string stop_name(std::size_t axis, std::size_t stop) {
  return "stop " + std::to_string(stop) + " of axis " + std::to_string(axis);
}

double axis_time_s(const PlannerParameters& parameters, const AxisSpec& axis, double way_m) {
  const double v = axis.max_velocity_mps;
  const double a = axis.max_acceleration_mps2;
  if (parameters.kinematics == "velocity") {
    return way_m / v;
  }
  // The peak velocity of a symmetric profile without a limit is sqrt(a * way).
  const double peak = std::min(v, std::sqrt(a * way_m));
  return way_m > 0.0 ? way_m / peak + peak / a : 0.0;
}

/// Time of a move after which it has gone a part of its way, found by halving on the position that
/// the profile has then.
double part_time_s(const PlannerParameters& parameters, const AxisSpec& axis, double part_m,
                   double way_m) {
  if (parameters.kinematics == "velocity") {
    return part_m / axis.max_velocity_mps;
  }
  const double a = axis.max_acceleration_mps2;
  const double peak = std::min(axis.max_velocity_mps, std::sqrt(a * way_m));
  const double end_s = axis_time_s(parameters, axis, way_m);
  const auto gone_m = [&](double t) {
    const double ramp_s = peak / a;
    if (t <= ramp_s) {
      return 0.5 * a * t * t;
    }
    if (t <= end_s - ramp_s) {
      return 0.5 * peak * ramp_s + peak * (t - ramp_s);
    }
    return way_m - 0.5 * a * (end_s - t) * (end_s - t);
  };
  double low = 0.0;
  double high = end_s;
  for (int i = 0; i < 50; ++i) {
    const double t = 0.5 * (low + high);
    (gone_m(t) < part_m ? low : high) = t;
  }
  return 0.5 * (low + high);
}

/// Gamma >= rho for the time that is left, by the logistic function; with a tolerance in robot way.
bool feasible(const PlannerParameters& parameters, double spare_s, double speed_mps) {
  const double s = spare_s + kTolerance_m / speed_mps;
  return 1.0 / (1.0 + std::exp(-parameters.omega * s)) >= parameters.rho;
}

}  // namespace

Status PlanChecker::check(const PlanningProblem& problem, const Plan& plan) {
  if (plan.routes.size() != problem.axes.size()) {
    return fault("has not one route for each axis");
  }
  if (plan.decisions.size() != problem.targets.size()) {
    return fault("has not one decision for each target");
  }
  const SpeedProfile* speeds = problem.speeds;
  if (speeds != nullptr && parameters_.fire_while_moving) {
    return fault("is for sprays in passing at speeds that change");
  }
  const double speed_mps = speeds != nullptr                        ? speeds->greatest_mps()
                           : parameters_.speed_source == "measured" ? problem.robot.speed_mps
                                                                    : parameters_.speed_mps;
  const auto elapsed_s = [&](double from_x_m, double to_x_m) {
    return speeds != nullptr ? speeds->time_s(to_x_m) - speeds->time_s(from_x_m)
                             : (to_x_m - from_x_m) / speed_mps;
  };
  // By id, the first given of equal ids first.
  seen_.clear();
  for (std::uint32_t i = 0; i < problem.targets.size(); ++i) {
    seen_.push_back({problem.targets[i].id, i, false});
    if (plan.decisions[i].id != problem.targets[i].id) {
      return fault("decision " + std::to_string(i) + " is for another target");
    }
  }
  std::sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
    return a.id != b.id ? a.id < b.id : a.index < b.index;
  });
  crops_by_x_.clear();
  double widest_m = 0.0;
  for (std::uint32_t i = 0; i < problem.protected_plants.size(); ++i) {
    crops_by_x_.push_back(i);
    widest_m = std::max(widest_m, problem.protected_plants[i].zone_m);
  }
  const auto crop_x = [&](std::uint32_t i) { return problem.protected_plants[i].p_F.x(); };
  std::sort(crops_by_x_.begin(), crops_by_x_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return crop_x(a) < crop_x(b); });
  const double common_m = parameters_.footprint_radius_m + parameters_.protection_zone_mm / 1000.0;
  widest_m += common_m;

  double weight = 0.0;
  double travel_m = 0.0;
  std::size_t treated = 0;
  for (std::size_t a = 0; a < plan.routes.size(); ++a) {
    const AxisSpec& axis = problem.axes[a];
    const AxisState& state = problem.states[a];
    const auto& route = plan.routes[a];
    if (!route.empty() && !state.in_service) {
      return fault("axis " + std::to_string(a) + " is out of service but has a route");
    }
    double from_x_m = std::max(state.free_from_x_m, problem.robot.x_m);
    double from_position_m = state.position_m;
    double dwell_s = parameters_.dwell_s * (state.after_spray ? 1.0 : 0.5);
    for (std::size_t s = 0; s < route.size(); ++s) {
      const Stop& stop = route[s];
      if (!stop.aim_F.allFinite() || !std::isfinite(stop.robot_x_m) ||
          std::abs(stop.robot_x_m + axis.offset_x_m - stop.aim_F.x()) > kTolerance_m ||
          std::abs(stop.position_m + problem.robot.y_m - stop.aim_F.y()) > kTolerance_m) {
        return fault(stop_name(a, s) + " does not agree with its aim");
      }
      if (stop.position_m < axis.lower_m - kTolerance_m ||
          stop.position_m > axis.upper_m + kTolerance_m) {
        return fault(stop_name(a, s) + " is outside the axis's span");
      }
      const double way_m = std::abs(stop.position_m - from_position_m);
      const double spare_s = elapsed_s(from_x_m, stop.robot_x_m) -
                             axis_time_s(parameters_, axis, way_m) - parameters_.settle_s - dwell_s;
      if (stop.moving) {
        if (!parameters_.fire_while_moving || s + 1 == route.size() || route[s + 1].moving) {
          return fault(stop_name(a, s) + " is fired in passing where that is not allowed");
        }
        const Stop& next = route[s + 1];
        const double whole_m = std::abs(next.position_m - from_position_m);
        const double before_s = part_time_s(parameters_, axis, way_m, whole_m);
        const double start_s = (stop.robot_x_m - from_x_m) / speed_mps - before_s;
        const double rest_s = 0.5 * parameters_.dwell_s * (s > 0 || state.after_spray ? 1.0 : 0.0);
        const double arrive_s = (next.robot_x_m - stop.robot_x_m) / speed_mps + before_s -
                                axis_time_s(parameters_, axis, whole_m) - parameters_.settle_s -
                                0.5 * parameters_.dwell_s;
        if (way_m + std::abs(next.position_m - stop.position_m) > whole_m + kTolerance_m ||
            start_s < rest_s - kTolerance_m / speed_mps ||
            !feasible(parameters_, arrive_s, speed_mps) ||
            std::abs(stop.depart_x_m - stop.robot_x_m + speed_mps * before_s) > kTolerance_m) {
          return fault(stop_name(a, s) + " is not passed by the move that it belongs to");
        }
      } else if (!feasible(parameters_, spare_s, speed_mps)) {
        return fault(stop_name(a, s) + " cannot be reached in time");
      }
      for (auto c =
               std::lower_bound(crops_by_x_.begin(), crops_by_x_.end(), stop.aim_F.x() - widest_m,
                                [&](std::uint32_t i, double x) { return crop_x(i) < x; });
           c != crops_by_x_.end() && crop_x(*c) <= stop.aim_F.x() + widest_m; ++c) {
        const ProtectedPlant& crop = problem.protected_plants[*c];
        if (std::hypot(crop.p_F.x() - stop.aim_F.x(), crop.p_F.y() - stop.aim_F.y()) <
            common_m + crop.zone_m - kTolerance_m) {
          return fault(stop_name(a, s) + " enters the protection zone of plant " +
                       std::to_string(crop.id));
        }
      }
      if (stop.target_count == 0 ||
          std::size_t{stop.first_target} + stop.target_count > plan.treated.size()) {
        return fault(stop_name(a, s) + " treats no target");
      }
      for (const TargetId id : plan.targets_of(stop)) {
        const auto entry = std::lower_bound(seen_.begin(), seen_.end(), id,
                                            [](const Seen& x, TargetId y) { return x.id < y; });
        if (entry == seen_.end() || entry->id != id) {
          return fault(stop_name(a, s) + " treats a target that was not given");
        }
        if (entry->treated) {
          return fault("target " + std::to_string(id) + " is treated twice");
        }
        entry->treated = true;
        const Target& target = problem.targets[entry->index];
        const TargetDecision& decision = plan.decisions[entry->index];
        if (decision.decision != Decision::kTreat ||
            decision.axis != static_cast<std::int32_t>(a)) {
          return fault("target " + std::to_string(id) + " is treated against its decision");
        }
        if (!(std::hypot(target.p_F.x() - stop.aim_F.x(), target.p_F.y() - stop.aim_F.y()) <=
              parameters_.footprint_radius_m + kTolerance_m)) {
          return fault("target " + std::to_string(id) + " is outside the footprint of " +
                       stop_name(a, s));
        }
        if (!(target.weight >= 0.0) || target.weight < parameters_.min_weight) {
          return fault("target " + std::to_string(id) + " should be left standing");
        }
        weight += target.weight;
        ++treated;
      }
      if (!stop.moving) {
        travel_m += way_m;
        from_x_m = stop.robot_x_m;
        from_position_m = stop.position_m;
        dwell_s = parameters_.dwell_s;
      }
    }
  }
  std::size_t decided = 0;
  for (const TargetDecision& decision : plan.decisions) {
    decided += decision.decision == Decision::kTreat ? 1U : 0U;
  }
  if (decided != treated) {
    return fault("a target is said to be treated, but by no stop");
  }
  const double tolerance = 1e-6 * std::max(1.0, weight);
  if (std::abs(weight - plan.weight) > tolerance ||
      std::abs(travel_m - plan.travel_m) > kTolerance_m * static_cast<double>(treated + 1)) {
    return fault("its sums are wrong");
  }
  return {};
}

}  // namespace furrow::planning
