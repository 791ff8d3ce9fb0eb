#include "furrow_planning/upper_bound.hpp"

#include <gtest/gtest.h>

#include "furrow_planning/route_planner.hpp"
#include "random_problem.hpp"

namespace furrow::planning {
namespace {

PlannerParameters footprint() {
  PlannerParameters parameters;
  parameters.planner = "footprint";
  return parameters;
}

TEST(FootprintBound, HoldsForEveryPlan) {
  Random random(51);
  double weight = 0.0;
  double bound = 0.0;
  double all = 0.0;
  for (int i = 0; i < 12; ++i) {
    const auto problem = random_problem(random, 150, 0.8, i % 3 + 1);
    auto parameters = footprint();
    parameters.kinematics = i % 2 == 0 ? "velocity" : "trapezoid";
    Plan plan;
    ASSERT_TRUE(make_route_planner(parameters)->plan(problem.view(), plan).ok());
    const auto of_problem = footprint_weight_bound(problem.view(), parameters, {.iterations = 30});
    ASSERT_TRUE(of_problem.ok());
    EXPECT_GE(*of_problem, plan.weight - 1e-9);
    EXPECT_LE(*of_problem, plan.weight_bound + 1e-9);
    weight += plan.weight;
    bound += *of_problem;
    all += plan.weight_bound;
  }
  // It says more than that no plan can treat more than everything.
  EXPECT_LT(bound, 0.95 * all);
  EXPECT_LT(weight, bound);
}

TEST(FootprintBound, IsTightForALoneWeedOutOfReach) {
  OwnedProblem problem;
  problem.axes.resize(1);
  problem.states.resize(1);
  problem.targets = {{.id = 1, .p_F = {0.5, 0.0}}, {.id = 2, .p_F = {0.005, 0.6}}};
  EXPECT_DOUBLE_EQ(*footprint_weight_bound(problem.view(), footprint(), {.iterations = 300}), 1.0);
}

TEST(FootprintBound, RefusesBadInput) {
  OwnedProblem problem;
  EXPECT_FALSE(footprint_weight_bound(problem.view(), footprint()).ok());
  problem.axes.resize(1);
  problem.states.resize(1);
  EXPECT_FALSE(footprint_weight_bound(problem.view(), footprint(), {.cell_m = 0.0}).ok());
  EXPECT_EQ(*footprint_weight_bound(problem.view(), footprint()), 0.0);
}

}  // namespace
}  // namespace furrow::planning
