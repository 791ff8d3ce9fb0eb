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

/// Time after which a move has covered a part of its way, by bisection on the profile's position.
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

/// Least distance of a spray's centre from the zone of a protected plant.
double keep_out_m(const PlannerParameters& parameters) {
  return parameters.footprint_radius_m + parameters.protection_zone_mm / 1000.0;
}

/// Gamma >= rho for the spare time, by the logistic function; with a tolerance in robot travel.
bool feasible(const PlannerParameters& parameters, double spare_s, double speed_mps) {
  const double s = spare_s + kTolerance_m / speed_mps;
  return 1.0 / (1.0 + std::exp(-parameters.omega * s)) >= parameters.rho;
}

/// Whether a stop fired in passing lies on the move to the next stop and keeps both margins.
bool passes(const PlannerParameters& parameters, const AxisSpec& axis, const Stop& stop,
            const Stop& next, double from_x_m, double from_position_m, bool sprayed_before,
            double speed_mps) {
  const double way_m = std::abs(stop.position_m - from_position_m);
  const double whole_m = std::abs(next.position_m - from_position_m);
  const double before_s = part_time_s(parameters, axis, way_m, whole_m);
  const double start_s = (stop.robot_x_m - from_x_m) / speed_mps - before_s;
  const double rest_s = 0.5 * parameters.dwell_s * (sprayed_before ? 1.0 : 0.0);
  const double arrive_s = (next.robot_x_m - stop.robot_x_m) / speed_mps + before_s -
                          axis_time_s(parameters, axis, whole_m) - parameters.settle_s -
                          0.5 * parameters.dwell_s;
  return way_m + std::abs(next.position_m - stop.position_m) <= whole_m + kTolerance_m &&
         start_s >= rest_s - kTolerance_m / speed_mps &&
         feasible(parameters, arrive_s, speed_mps) &&
         std::abs(stop.depart_x_m - stop.robot_x_m + speed_mps * before_s) <= kTolerance_m;
}

}  // namespace

Status PlanChecker::check(const PlanningProblem& problem, const Plan& plan) {
  if (Status status = check_shape(problem, plan); !status.ok()) return status;
  speed_mps_ = problem.speeds != nullptr                ? problem.speeds->greatest_mps()
               : parameters_.speed_source == "measured" ? problem.robot.speed_mps
                                                        : parameters_.speed_mps;
  sort_crops(problem);
  weight_ = 0.0;
  travel_m_ = 0.0;
  treated_ = 0;
  for (std::size_t a = 0; a < plan.routes.size(); ++a) {
    if (Status status = check_route(problem, plan, a); !status.ok()) return status;
  }
  return check_sums(plan);
}

Status PlanChecker::check_shape(const PlanningProblem& problem, const Plan& plan) {
  if (plan.routes.size() != problem.axes.size()) {
    return fault("the numbers of routes and axes differ");
  }
  if (plan.decisions.size() != problem.targets.size()) {
    return fault("the numbers of decisions and targets differ");
  }
  if (problem.speeds != nullptr && parameters_.fire_while_moving) {
    return fault("sprays in passing need a constant speed");
  }
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
  return {};
}

void PlanChecker::sort_crops(const PlanningProblem& problem) {
  crops_by_x_.clear();
  double widest_m = 0.0;
  for (std::uint32_t i = 0; i < problem.protected_plants.size(); ++i) {
    crops_by_x_.push_back(i);
    widest_m = std::max(widest_m, problem.protected_plants[i].zone_m);
  }
  const auto crop_x = [&](std::uint32_t i) { return problem.protected_plants[i].p_F.x(); };
  std::sort(crops_by_x_.begin(), crops_by_x_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return crop_x(a) < crop_x(b); });
  widest_zone_m_ = widest_m + keep_out_m(parameters_);
}

Status PlanChecker::check_route(const PlanningProblem& problem, const Plan& plan, std::size_t a) {
  const AxisState& state = problem.states[a];
  const auto& route = plan.routes[a];
  if (!route.empty() && !state.in_service) {
    return fault("axis " + std::to_string(a) + " is out of service but has a route");
  }
  Walk walk{.from_x_m = std::max(state.free_from_x_m, problem.robot.x_m),
            .from_position_m = state.position_m,
            .dwell_s = parameters_.dwell_s * (state.after_spray ? 1.0 : 0.5),
            .sprayed = state.after_spray};
  for (std::size_t s = 0; s < route.size(); ++s) {
    const Stop& stop = route[s];
    if (Status status = check_aim(problem, a, s, stop); !status.ok()) return status;
    if (Status status = check_timing(problem, plan, a, s, walk); !status.ok()) return status;
    if (Status status = check_crops(problem, a, s, stop); !status.ok()) return status;
    if (Status status = check_targets(problem, plan, a, s); !status.ok()) return status;
    walk.sprayed = true;
    if (stop.moving) continue;
    travel_m_ += std::abs(stop.position_m - walk.from_position_m);
    walk.from_x_m = stop.robot_x_m;
    walk.from_position_m = stop.position_m;
    walk.dwell_s = parameters_.dwell_s;
  }
  return {};
}

Status PlanChecker::check_aim(const PlanningProblem& problem, std::size_t a, std::size_t s,
                              const Stop& stop) const {
  const AxisSpec& axis = problem.axes[a];
  if (!stop.aim_F.allFinite() || !std::isfinite(stop.robot_x_m) ||
      std::abs(stop.robot_x_m + axis.offset_x_m - stop.aim_F.x()) > kTolerance_m ||
      std::abs(stop.position_m + problem.robot.y_m - stop.aim_F.y()) > kTolerance_m) {
    return fault(stop_name(a, s) + " does not agree with its aim");
  }
  if (stop.position_m < axis.lower_m - kTolerance_m ||
      stop.position_m > axis.upper_m + kTolerance_m) {
    return fault(stop_name(a, s) + " is outside the axis's span");
  }
  return {};
}

Status PlanChecker::check_timing(const PlanningProblem& problem, const Plan& plan, std::size_t a,
                                 std::size_t s, const Walk& walk) const {
  const AxisSpec& axis = problem.axes[a];
  const auto& route = plan.routes[a];
  const Stop& stop = route[s];
  if (stop.moving) {
    if (!parameters_.fire_while_moving || s + 1 == route.size() || route[s + 1].moving) {
      return fault(stop_name(a, s) + " is fired in passing where that is not allowed");
    }
    if (!passes(parameters_, axis, stop, route[s + 1], walk.from_x_m, walk.from_position_m,
                walk.sprayed, speed_mps_)) {
      return fault(stop_name(a, s) + " is not passed by the move that it belongs to");
    }
    return {};
  }
  const SpeedProfile* speeds = problem.speeds;
  const double elapsed_s = speeds != nullptr
                               ? speeds->time_s(stop.robot_x_m) - speeds->time_s(walk.from_x_m)
                               : (stop.robot_x_m - walk.from_x_m) / speed_mps_;
  const double way_m = std::abs(stop.position_m - walk.from_position_m);
  const double spare_s =
      elapsed_s - axis_time_s(parameters_, axis, way_m) - parameters_.settle_s - walk.dwell_s;
  if (!feasible(parameters_, spare_s, speed_mps_)) {
    return fault(stop_name(a, s) + " cannot be reached in time");
  }
  return {};
}

Status PlanChecker::check_crops(const PlanningProblem& problem, std::size_t a, std::size_t s,
                                const Stop& stop) const {
  const auto crop_x = [&](std::uint32_t i) { return problem.protected_plants[i].p_F.x(); };
  auto c = std::lower_bound(crops_by_x_.begin(), crops_by_x_.end(), stop.aim_F.x() - widest_zone_m_,
                            [&](std::uint32_t i, double x) { return crop_x(i) < x; });
  for (; c != crops_by_x_.end() && crop_x(*c) <= stop.aim_F.x() + widest_zone_m_; ++c) {
    const ProtectedPlant& crop = problem.protected_plants[*c];
    const double distance_m =
        std::hypot(crop.p_F.x() - stop.aim_F.x(), crop.p_F.y() - stop.aim_F.y());
    if (distance_m < keep_out_m(parameters_) + crop.zone_m - kTolerance_m) {
      return fault(stop_name(a, s) + " enters the protection zone of plant " +
                   std::to_string(crop.id));
    }
  }
  return {};
}

Status PlanChecker::check_targets(const PlanningProblem& problem, const Plan& plan, std::size_t a,
                                  std::size_t s) {
  const Stop& stop = plan.routes[a][s];
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
    if (entry->treated) return fault("target " + std::to_string(id) + " is treated twice");
    entry->treated = true;
    const Target& target = problem.targets[entry->index];
    const TargetDecision& decision = plan.decisions[entry->index];
    if (decision.decision != Decision::kTreat || decision.axis != static_cast<std::int32_t>(a)) {
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
    weight_ += target.weight;
    ++treated_;
  }
  return {};
}

Status PlanChecker::check_sums(const Plan& plan) const {
  std::size_t decided = 0;
  for (const TargetDecision& decision : plan.decisions) {
    decided += decision.decision == Decision::kTreat ? 1U : 0U;
  }
  if (decided != treated_) {
    return fault("a target has the decision to treat, but no stop treats it");
  }
  const double tolerance = 1e-6 * std::max(1.0, weight_);
  if (std::abs(weight_ - plan.weight) > tolerance ||
      std::abs(travel_m_ - plan.travel_m) > kTolerance_m * static_cast<double>(treated_ + 1)) {
    return fault("the sums of weight or travel are wrong");
  }
  return {};
}

}  // namespace furrow::planning
