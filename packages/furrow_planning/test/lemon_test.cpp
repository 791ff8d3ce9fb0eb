#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "furrow_planning/kinematics.hpp"
#include "furrow_planning/route_planner.hpp"
#include "lemon_oracle.hpp"
#include "random_problem.hpp"

namespace furrow::planning {
namespace {

/// The joint problem as a plain flow with an arc for every feasible pair, weights in millionths.
long long optimum_by_network_simplex(const PlannerParameters& parameters,
                                     const OwnedProblem& problem) {
  const Transition transition(parameters, parameters.speed_mps, problem.axes[0]);
  const int axes = static_cast<int>(problem.axes.size());
  const int n = static_cast<int>(problem.targets.size());
  const auto in = [&](int k) { return 1 + axes + 2 * k; };
  const int sink = in(n);
  const auto inside = [&](const Target& target) {
    return std::abs(target.p_F.y() - problem.robot.y_m) <= 0.695;
  };
  std::vector<OracleArc> arcs;
  for (int a = 0; a < axes; ++a) {
    const AxisState& state = problem.states[static_cast<std::size_t>(a)];
    arcs.push_back({0, 1 + a, 1, 0});
    for (int k = 0; k < n; ++k) {
      const Target& target = problem.targets[static_cast<std::size_t>(k)];
      const double dx = target.p_F.x() - problem.axes[static_cast<std::size_t>(a)].offset_x_m -
                        std::max(state.free_from_x_m, problem.robot.x_m);
      const double dy = target.p_F.y() - problem.robot.y_m - state.position_m;
      if (inside(target) && transition.first_feasible(dx, dy)) {
        arcs.push_back({1 + a, in(k), 1, 0});
      }
    }
  }
  for (int j = 0; j < n; ++j) {
    const Target& from = problem.targets[static_cast<std::size_t>(j)];
    arcs.push_back({in(j), in(j) + 1, 1, -std::llround(from.weight * 1e6)});
    arcs.push_back({in(j) + 1, sink, 1, 0});
    for (int k = 0; k < n; ++k) {
      const Target& to = problem.targets[static_cast<std::size_t>(k)];
      if (inside(from) && inside(to) &&
          transition.feasible(to.p_F.x() - from.p_F.x(), to.p_F.y() - from.p_F.y())) {
        arcs.push_back({in(j) + 1, in(k), 1, 0});
      }
    }
  }
  return -lemon_min_cost(sink + 1, arcs, axes);
}

TEST(JointFlow, EqualsLemonsNetworkSimplex) {
  Random random(21);
  for (int i = 0; i < 400; ++i) {
    const int targets = static_cast<int>(random.integer(1, 120));
    const int axes = static_cast<int>(random.integer(1, 6));
    const auto problem = random_problem(random, targets, random.uniform(0.1, 2.0), axes);
    PlannerParameters parameters;
    parameters.planner = "exact";
    parameters.kinematics = i % 2 == 0 ? "velocity" : "trapezoid";
    Plan plan;
    ASSERT_TRUE(make_route_planner(parameters)->plan(problem.view(), plan).ok());
    const long long optimum = optimum_by_network_simplex(parameters, problem);
    // Both round weights to about a millionth of the greatest.
    ASSERT_NEAR(plan.weight, 1e-6 * static_cast<double>(optimum), 2e-6 * targets + 1e-9) << i;
  }
}

}  // namespace
}  // namespace furrow::planning
