#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "furrow_planning/kinematics.hpp"
#include "furrow_planning/plan_checker.hpp"
#include "furrow_planning/route_planner.hpp"
#include "random_problem.hpp"

namespace furrow::planning {
namespace {

PlannerParameters parameters_for(const char* planner, const char* assignment,
                                 const char* kinematics = "velocity") {
  PlannerParameters parameters;
  parameters.planner = planner;
  parameters.assignment = assignment;
  parameters.kinematics = kinematics;
  return parameters;
}

Plan plan_of(const PlannerParameters& parameters, const OwnedProblem& problem) {
  Plan plan;
  const Status status = make_route_planner(parameters)->plan(problem.view(), plan);
  EXPECT_TRUE(status.ok());
  const Status checked = PlanChecker(parameters).check(problem.view(), plan);
  EXPECT_TRUE(checked.ok()) << checked.error().message;
  return plan;
}

TEST(ExactChain, EqualsThePermutationOracle) {
  Random random(11);
  int contested = 0;
  for (int i = 0; i < 4000; ++i) {
    const int targets = static_cast<int>(random.integer(0, 9));
    const auto problem = random_problem(random, targets, random.uniform(0.1, 0.6), 1);
    const char* kinematics = i % 2 == 0 ? "velocity" : "trapezoid";
    const Plan exact = plan_of(parameters_for("exact", "static", kinematics), problem);
    const Plan oracle = plan_of(parameters_for("permutation", "static", kinematics), problem);
    ASSERT_NEAR(exact.weight, oracle.weight, 1e-5);
    contested += exact.routes[0].size() < problem.targets.size() ? 1 : 0;
  }
  EXPECT_GT(contested, 1000);
}

TEST(ExactChain, IsNeverWorseThanTheHeuristics) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const auto problem = random_problem(random, 60, 1.0, 4);
    for (const char* assignment : {"distance", "static", "dynamic"}) {
      const double exact = plan_of(parameters_for("exact", assignment), problem).weight;
      for (const char* planner : {"greedy", "notsp", "permutation"}) {
        EXPECT_LE(plan_of(parameters_for(planner, assignment), problem).weight, exact + 1e-4);
      }
    }
  }
}

/// Every way to give each target to one of the axes or to none, in the order of x; the feasibility
/// from the definitions. Returns {weight, -travel} of the best.
std::pair<double, double> best_by_enumeration(const PlannerParameters& parameters,
                                              const OwnedProblem& problem) {
  std::vector<Target> targets = problem.targets;
  std::sort(targets.begin(), targets.end(),
            [](const Target& a, const Target& b) { return a.p_F.x() < b.p_F.x(); });
  struct Head {
    double x;
    double position;
  };
  std::vector<Head> heads;
  for (const AxisState& state : problem.states) {
    heads.push_back({std::max(state.free_from_x_m, problem.robot.x_m), state.position_m});
  }
  std::pair<double, double> best{0.0, 0.0};
  const std::function<void(std::size_t, double, double)> extend = [&](std::size_t i, double weight,
                                                                      double travel) {
    if (i == targets.size()) {
      if (weight > best.first + 1e-9 ||
          (weight > best.first - 1e-9 && -travel > best.second + 1e-12)) {
        best = {weight, -travel};
      }
      return;
    }
    extend(i + 1, weight, travel);
    for (std::size_t a = 0; a < heads.size(); ++a) {
      const double x = targets[i].p_F.x() - problem.axes[a].offset_x_m;
      const double position = targets[i].p_F.y() - problem.robot.y_m;
      if (position < problem.axes[a].lower_m || position > problem.axes[a].upper_m) {
        continue;
      }
      const double way = std::abs(position - heads[a].position);
      const double move = move_time_s(
          parameters.kinematics == "velocity" ? Kinematics::kVelocity : Kinematics::kTrapezoid, way,
          problem.axes[a].max_velocity_mps, 50.0);
      if (feasibility((x - heads[a].x) / parameters.speed_mps - move, parameters.omega) <
          parameters.rho) {
        continue;
      }
      const Head before = heads[a];
      heads[a] = {x, position};
      extend(i + 1, weight + targets[i].weight, travel + way);
      heads[a] = before;
    }
  };
  extend(0, 0.0, 0.0);
  return best;
}

TEST(Joint, EqualsEnumerationInWeightAndTravel) {
  Random random(13);
  int contested = 0;
  for (int i = 0; i < 1200; ++i) {
    const int axes = static_cast<int>(random.integer(1, 3));
    const auto problem = random_problem(random, static_cast<int>(random.integer(1, 7)),
                                        random.uniform(0.05, 0.4), axes);
    const auto parameters = parameters_for("exact", "joint", i % 2 == 0 ? "velocity" : "trapezoid");
    const Plan plan = plan_of(parameters, problem);
    const auto [weight, travel] = best_by_enumeration(parameters, problem);
    ASSERT_NEAR(plan.weight, weight, 1e-5) << i;
    // Travel is compared in steps of a 1024th of the span, one rounding for each stop.
    ASSERT_NEAR(plan.travel_m, -travel, 8 * 1.39 / 1024.0) << i;
    EXPECT_DOUBLE_EQ(plan.weight_bound, plan.weight);
    contested += weight < 0.99 * static_cast<double>(problem.targets.size()) ? 1 : 0;
  }
  EXPECT_GT(contested, 300);
}

TEST(Joint, AxesThatDifferComeCloseToTheOptimum) {
  Random random(15);
  double lost = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 400; ++i) {
    auto problem = random_problem(random, 7, 0.2, 3);
    problem.axes[0].lower_m = -0.2;
    problem.axes[1].upper_m = 0.1;
    problem.axes[2].max_velocity_mps = i % 2 == 0 ? 5.0 : 2.0;
    const auto parameters = parameters_for("exact", "joint");
    const double optimum = best_by_enumeration(parameters, problem).first;
    const Plan plan = plan_of(parameters, problem);
    EXPECT_LE(plan.weight, optimum + 1e-5);
    EXPECT_GE(plan.weight_bound, optimum - 1e-5);
    lost += optimum - plan.weight;
    sum += optimum;
  }
  EXPECT_LT(lost / sum, 0.01);
}

TEST(Joint, ManyTargetsStayFeasible) {
  Random random(16);
  for (const int targets : {200, 1000}) {
    const auto problem = random_problem(random, targets, 0.01 * targets, 4);
    const Plan joint = plan_of(parameters_for("exact", "joint"), problem);
    const Plan divided = plan_of(parameters_for("exact", "static"), problem);
    EXPECT_GE(joint.weight, divided.weight);
  }
}

TEST(DividedPlanner, ThreadsDoNotChangeThePlan) {
  Random random(17);
  for (const char* planner : {"greedy", "notsp", "permutation", "exact"}) {
    const auto problem = random_problem(random, 120, 1.0, 4);
    auto parameters = parameters_for(planner, "dynamic");
    const Plan one = plan_of(parameters, problem);
    parameters.threads = 4;
    const Plan four = plan_of(parameters, problem);
    EXPECT_EQ(one.treated, four.treated);
    EXPECT_EQ(one.travel_m, four.travel_m);
  }
}

}  // namespace
}  // namespace furrow::planning
