#include "prepared_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace furrow::planning {
namespace {

Status check_problem(const PlanningProblem& problem, const PlannerParameters& parameters) {
  const auto bad = [](std::string message) {
    return Error{ErrorCode::kInvalidArgument, std::move(message)};
  };
  if (problem.axes.empty()) {
    return bad("there is no axis to plan for");
  }
  if (problem.axes.size() != problem.states.size()) {
    return bad("there are " + std::to_string(problem.states.size()) + " axis states for " +
               std::to_string(problem.axes.size()) + " axes");
  }
  if (problem.targets.size() > static_cast<std::size_t>(parameters.max_targets)) {
    return bad(std::to_string(problem.targets.size()) + " targets are more than max_targets");
  }
  const RobotState& robot = problem.robot;
  if (!std::isfinite(robot.x_m) || !std::isfinite(robot.y_m)) {
    return bad("the robot's position is not finite");
  }
  if (problem.speeds != nullptr && parameters.fire_while_moving) {
    return bad("sprays in passing are planned at a constant speed only");
  }
  if (problem.speeds == nullptr && parameters.speed_source == "measured" &&
      !(std::isfinite(robot.speed_mps) && robot.speed_mps > 0.0)) {
    return bad("the robot's speed is not positive");
  }
  for (std::size_t a = 0; a < problem.axes.size(); ++a) {
    const AxisSpec& axis = problem.axes[a];
    const AxisState& state = problem.states[a];
    if (!std::isfinite(axis.offset_x_m) || !std::isfinite(axis.lower_m) ||
        !std::isfinite(axis.upper_m) || !(axis.lower_m < axis.upper_m) ||
        !std::isfinite(state.position_m) || !std::isfinite(state.free_from_x_m)) {
      return bad("axis " + std::to_string(a) + " has a span or state that is not sound");
    }
  }
  for (const ProtectedPlant& plant : problem.protected_plants) {
    if (!plant.p_F.allFinite() || !std::isfinite(plant.zone_m) || plant.zone_m < 0.0) {
      return bad("protected plant " + std::to_string(plant.id) + " is not sound");
    }
  }
  return {};
}

/// Marks all but the first of equal ids.
void mark_duplicates(std::span<const Target> targets, std::vector<std::uint32_t>& order,
                     Plan& plan) {
  order.resize(targets.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return targets[a].id != targets[b].id ? targets[a].id < targets[b].id : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (targets[order[i]].id == targets[order[i - 1]].id) {
      plan.decisions[order[i]].decision = Decision::kDuplicate;
    }
  }
}

Decision classify(const Target& target, const PlanningProblem& problem,
                  const PlannerParameters& parameters, double aim_reach_m,
                  const std::vector<Start>& starts) {
  if (!target.p_F.allFinite() || !std::isfinite(target.weight) || target.weight < 0.0) {
    return Decision::kInvalid;
  }
  if (target.weight < parameters.min_weight || target.weight <= 0.0) {
    return Decision::kLowPriority;
  }
  bool spanned = false;
  bool ahead = false;
  bool served = false;
  for (const Start& start : starts) {
    if (target.p_F.y() < start.lower_y_m - aim_reach_m ||
        target.p_F.y() > start.upper_y_m + aim_reach_m) {
      continue;
    }
    spanned = true;
    if (target.p_F.x() + aim_reach_m - start.offset_x_m <= problem.robot.x_m) {
      continue;
    }
    ahead = true;
    served = served || start.usable;
  }
  if (!spanned) {
    return Decision::kOutside;
  }
  if (!ahead) {
    return Decision::kBehind;
  }
  return served ? Decision::kUnreachable : Decision::kAxisFault;
}

/// Writes a start for each axis. Returns the greatest move of any axis, for the scale of travel.
double write_starts(const PlanningProblem& problem, const PlannerParameters& parameters,
                    PreparedProblem& prepared) {
  prepared.starts.clear();
  double extent_m = 1e-6;
  for (std::size_t a = 0; a < problem.axes.size(); ++a) {
    const AxisSpec& axis = problem.axes[a];
    const AxisState& state = problem.states[a];
    prepared.starts.push_back(
        {.x_m = std::max(state.free_from_x_m, problem.robot.x_m) + axis.offset_x_m,
         .y_m = problem.robot.y_m + state.position_m,
         .lower_y_m = problem.robot.y_m + axis.lower_m,
         .upper_y_m = problem.robot.y_m + axis.upper_m,
         .offset_x_m = axis.offset_x_m,
         .usable = state.in_service,
         .after_spray = state.after_spray,
         .transition = Transition(parameters, prepared.speed_mps, axis),
         .speeds = problem.speeds});
    extent_m = std::max({extent_m, axis.upper_m - axis.lower_m, axis.upper_m - state.position_m,
                         state.position_m - axis.lower_m});
  }
  return extent_m;
}

/// Writes the nodes in order and the decisions. Returns the greatest weight.
double write_nodes(const PlanningProblem& problem, const PlannerParameters& parameters,
                   double aim_reach_m, PreparedProblem& prepared, Plan& plan) {
  prepared.nodes.clear();
  double greatest = 0.0;
  for (std::size_t i = 0; i < problem.targets.size(); ++i) {
    const Target& target = problem.targets[i];
    Decision& decision = plan.decisions[i].decision;
    if (decision == Decision::kDuplicate) continue;
    decision = classify(target, problem, parameters, aim_reach_m, prepared.starts);
    if (decision != Decision::kUnreachable) continue;
    prepared.nodes.push_back({.x_m = target.p_F.x(),
                              .y_m = target.p_F.y(),
                              .weight = target.weight,
                              .target = static_cast<std::uint32_t>(i)});
    greatest = std::max(greatest, target.weight);
  }
  std::sort(prepared.nodes.begin(), prepared.nodes.end(), [](const Node& a, const Node& b) {
    if (a.x_m != b.x_m) return a.x_m < b.x_m;
    return a.y_m != b.y_m ? a.y_m < b.y_m : a.target < b.target;
  });
  return greatest;
}

}  // namespace

double treat_radius_m(const PlannerParameters& parameters) {
  return std::max(0.0, parameters.footprint_radius_m - parameters.placement_margin_m);
}

double keep_out_m(const PlannerParameters& parameters, const ProtectedPlant& plant) {
  return parameters.footprint_radius_m + 1e-3 * parameters.protection_zone_mm + plant.zone_m;
}

Status prepare(const PlanningProblem& problem, const PlannerParameters& parameters,
               double aim_reach_m, PreparedProblem& prepared, Plan& plan) {
  plan.clear(problem.axes.size());
  if (Status status = check_problem(problem, parameters); !status) {
    return status;
  }
  prepared.speed_mps = problem.speeds != nullptr               ? problem.speeds->greatest_mps()
                       : parameters.speed_source == "measured" ? problem.robot.speed_mps
                                                               : parameters.speed_mps;
  prepared.robot_y_m = problem.robot.y_m;
  const double extent_m = write_starts(problem, parameters, prepared);
  plan.decisions.resize(problem.targets.size());
  for (std::size_t i = 0; i < problem.targets.size(); ++i) {
    plan.decisions[i] = {.id = problem.targets[i].id, .decision = Decision::kTreat, .axis = -1};
  }
  mark_duplicates(problem.targets, prepared.order, plan);
  const double greatest = write_nodes(problem, parameters, aim_reach_m, prepared, plan);
  prepared.scoring.scores_per_weight =
      greatest > 0.0 ? static_cast<double>(Scoring::kWeightLevels) / greatest : 0.0;
  prepared.scoring.levels_per_m = static_cast<double>(Scoring::kTravelLevels) / extent_m;
  for (Node& node : prepared.nodes) {
    node.score = std::max<std::int64_t>(
        1, std::llround(node.weight / greatest * static_cast<double>(Scoring::kWeightLevels)));
  }
  return {};
}

void drop_protected(const PlanningProblem& problem, const PlannerParameters& parameters,
                    PreparedProblem& prepared, Plan& plan) {
  for (const ProtectedPlant& plant : problem.protected_plants) {
    const double radius_m = keep_out_m(parameters, plant);
    const auto first =
        std::lower_bound(prepared.nodes.begin(), prepared.nodes.end(), plant.p_F.x() - radius_m,
                         [](const Node& node, double x) { return node.x_m < x; });
    for (auto node = first; node != prepared.nodes.end() && node->x_m <= plant.p_F.x() + radius_m;
         ++node) {
      const double dx = node->x_m - plant.p_F.x();
      const double dy = node->y_m - plant.p_F.y();
      if (dx * dx + dy * dy < radius_m * radius_m) {
        plan.decisions[node->target].decision = Decision::kProtectedCrop;
      }
    }
  }
  std::erase_if(prepared.nodes, [&](const Node& node) {
    return plan.decisions[node.target].decision == Decision::kProtectedCrop;
  });
}

void time_stop(const Start& start, double robot_y_m, const Stop* previous, Stop& stop) {
  stop.robot_x_m = stop.aim_F.x() - start.offset_x_m;
  stop.position_m = stop.aim_F.y() - robot_y_m;
  const double from_y_m = previous != nullptr ? previous->aim_F.y() : start.y_m;
  const double before_m = start.transition.first_dx_m(stop.aim_F.y() - from_y_m);
  stop.depart_x_m = start.speeds == nullptr
                        ? stop.robot_x_m - before_m
                        : start.speeds->x_m(start.speeds->time_s(stop.robot_x_m) -
                                            before_m / start.transition.speed_mps());
}

void write_chains(const PlanningProblem& problem, const PreparedProblem& prepared,
                  const std::vector<std::vector<std::uint32_t>>& chains, Plan& plan) {
  for (std::size_t a = 0; a < chains.size(); ++a) {
    const Start& start = prepared.starts[a];
    double y_m = start.y_m;
    auto& route = plan.routes[a];
    for (const std::uint32_t k : chains[a]) {
      const Node& node = prepared.nodes[k];
      const Target& target = problem.targets[node.target];
      Stop stop{.aim_F = target.p_F,
                .first_target = static_cast<std::uint32_t>(plan.treated.size()),
                .target_count = 1};
      time_stop(start, prepared.robot_y_m, route.empty() ? nullptr : &route.back(), stop);
      route.push_back(stop);
      plan.treated.push_back(target.id);
      plan.decisions[node.target].decision = Decision::kTreat;
      plan.decisions[node.target].axis = static_cast<std::int32_t>(a);
      plan.weight += node.weight;
      plan.travel_m += std::abs(node.y_m - y_m);
      y_m = node.y_m;
    }
  }
}

}  // namespace furrow::planning
