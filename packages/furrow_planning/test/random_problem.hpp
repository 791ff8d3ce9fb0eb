#pragma once

#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// Owns what a PlanningProblem refers to.
struct OwnedProblem {
  std::vector<Target> targets;
  std::vector<ProtectedPlant> crops;
  std::vector<AxisSpec> axes;
  std::vector<AxisState> states;
  RobotState robot;

  [[nodiscard]] PlanningProblem view() const {
    return {.targets = targets,
            .protected_plants = crops,
            .axes = axes,
            .states = states,
            .robot = robot};
  }
};

/// `targets` weeds over `length_m` ahead of the robot, `axes` axes 0.12 m apart along x.
inline OwnedProblem random_problem(Random& random, int targets, double length_m, int axes) {
  OwnedProblem problem;
  problem.robot = {.x_m = random.uniform(-5.0, 5.0), .y_m = random.uniform(-0.02, 0.02)};
  for (int a = 0; a < axes; ++a) {
    problem.axes.push_back({.offset_x_m = 0.06 * (axes - 1) - 0.12 * a});
    problem.states.push_back({.position_m = random.uniform(-0.695, 0.695),
                              .free_from_x_m = problem.robot.x_m + random.uniform(-0.05, 0.1),
                              .after_spray = random.bernoulli(0.5)});
  }
  for (int i = 0; i < targets; ++i) {
    Target target;
    target.id = 100 + i;
    target.p_F = {problem.robot.x_m + random.uniform(-0.2, length_m), random.uniform(-0.7, 0.7)};
    target.weight = random.bernoulli(0.5) ? 1.0 : random.uniform(0.1, 1.0);
    problem.targets.push_back(target);
  }
  return problem;
}

}  // namespace furrow::planning
