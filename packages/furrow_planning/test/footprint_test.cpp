#include <gtest/gtest.h>

#include <cmath>

#include "furrow_planning/plan_checker.hpp"
#include "furrow_planning/route_planner.hpp"
#include "random_problem.hpp"

namespace furrow::planning {
namespace {

PlannerParameters footprint() {
  PlannerParameters parameters;
  parameters.planner = "footprint";
  parameters.assignment = "joint";
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

OwnedProblem one_axis(std::vector<Target> targets) {
  OwnedProblem problem;
  problem.axes.resize(1);
  problem.states.resize(1);
  problem.targets = std::move(targets);
  return problem;
}

TEST(Footprint, LoneWeedIsHitInTheCentre) {
  const Plan plan = plan_of(footprint(), one_axis({{.id = 1, .p_F = {0.5, 0.3}}}));
  ASSERT_EQ(plan.routes[0].size(), 1U);
  EXPECT_EQ(plan.routes[0][0].aim_F, Eigen::Vector2d(0.5, 0.3));
  EXPECT_DOUBLE_EQ(plan.travel_m, 0.3);
}

TEST(Footprint, OneSprayTreatsSeveralWeeds) {
  // An equilateral triangle of 40 mm has its corners 23.1 mm from its centre.
  const double h = 0.04 * std::sqrt(3.0) / 2.0;
  const auto problem = one_axis({{.id = 1, .p_F = {0.5, -0.02}},
                                 {.id = 2, .p_F = {0.5, 0.02}},
                                 {.id = 3, .p_F = {0.5 + h, 0.0}}});
  auto parameters = footprint();
  parameters.centre_preference = 0.0;
  const Plan plan = plan_of(parameters, problem);
  ASSERT_EQ(plan.routes[0].size(), 1U);
  EXPECT_EQ(plan.routes[0][0].target_count, 3U);
  EXPECT_DOUBLE_EQ(plan.weight, 3.0);
  // With 3 mm spare at the rim one spray is not enough.
  auto careful = parameters;
  careful.placement_margin_m = 0.003;
  EXPECT_GT(plan_of(careful, problem).routes[0].size(), 1U);
}

TEST(Footprint, ShiftsAlongTheTravelToBeInTime) {
  // Exactly abreast and 0.3 m apart: the axis needs 10 + 30 mm of way between them.
  const auto problem = one_axis({{.id = 1, .p_F = {0.5, -0.15}}, {.id = 2, .p_F = {0.5, 0.15}}});
  EXPECT_DOUBLE_EQ(plan_of(footprint(), problem).weight, 2.0);
  auto exact = footprint();
  exact.planner = "exact";
  EXPECT_DOUBLE_EQ(plan_of(exact, problem).weight, 1.0);
}

TEST(Footprint, ReachesALittleBeyondTheSpan) {
  const auto problem = one_axis({{.id = 1, .p_F = {0.5, 0.715}}, {.id = 2, .p_F = {0.9, -0.725}}});
  const Plan plan = plan_of(footprint(), problem);
  EXPECT_EQ(plan.decisions[0].decision, Decision::kTreat);
  EXPECT_LE(plan.routes[0].at(0).position_m, 0.695);
  EXPECT_EQ(plan.decisions[1].decision, Decision::kOutside);
}

TEST(Footprint, SpraysBesideACropAndLeavesWhatIsTooNear) {
  // Zone of 25 + 10 mm: a stem 20 mm from the crop's is treated from 15 mm farther out, one at
  // 5 mm would ask for 30 mm.
  auto problem = one_axis({{.id = 1, .p_F = {0.5, 0.02}}, {.id = 2, .p_F = {0.9, 0.005}}});
  problem.crops = {{.id = 1, .p_F = {0.5, 0.0}}, {.id = 2, .p_F = {0.9, 0.0}}};
  auto parameters = footprint();
  parameters.protection_zone_mm = 10.0;
  const Plan plan = plan_of(parameters, problem);
  EXPECT_EQ(plan.decisions[0].decision, Decision::kTreat);
  EXPECT_GE((plan.routes[0].at(0).aim_F - problem.crops[0].p_F).norm(), 0.035);
  EXPECT_EQ(plan.decisions[1].decision, Decision::kProtectedCrop);
}

TEST(Footprint, NeverTreatsLessThanSpraysOnStems) {
  Random random(41);
  for (int i = 0; i < 200; ++i) {
    auto problem = random_problem(random, static_cast<int>(random.integer(1, 150)), 1.2, 4);
    for (int c = 0; c < 10; ++c) {
      problem.crops.push_back(
          {.id = c,
           .p_F = {problem.robot.x_m + random.uniform(0.0, 1.2), random.uniform(-0.7, 0.7)}});
    }
    auto parameters = footprint();
    parameters.protection_zone_mm = 5.0;
    parameters.kinematics = i % 2 == 0 ? "velocity" : "trapezoid";
    const Plan plan = plan_of(parameters, problem);
    auto stems = parameters;
    stems.planner = "exact";
    const Plan exact = plan_of(stems, problem);
    // A share of a thousandth is left to the preference for the centre.
    EXPECT_GE(plan.weight, exact.weight * (1.0 - 1e-3) - 1e-3);
    EXPECT_LE(plan.weight, plan.weight_bound + 1e-9);
  }
}

TEST(Footprint, PrefersStemsNearTheCentre) {
  Random random(42);
  double far = 0.0;
  double all = 0.0;
  for (int i = 0; i < 50; ++i) {
    const auto problem = random_problem(random, 30, 1.2, 4);
    const Plan plan = plan_of(footprint(), problem);
    for (const auto& route : plan.routes) {
      for (const Stop& stop : route) {
        double before = 0.0;
        for (const TargetId id : plan.targets_of(stop)) {
          const auto& target = problem.targets[static_cast<std::size_t>(id - 100)];
          const double distance = (target.p_F - stop.aim_F).norm();
          EXPECT_GE(distance, before - 1e-6);  // sorted to the micrometre
          before = distance;
          far += distance > 0.01 ? 1.0 : 0.0;
          all += 1.0;
        }
      }
    }
  }
  EXPECT_LT(far / all, 0.35);
}

TEST(Footprint, FiresInPassing) {
  // Available: 0.16 + 2 * 0.025 m of robot travel. From rest to rest the outer two need 0.17 m and
  // the margin of 10 mm. A stop at the middle one would need 0.10 + 0.12 m and twice the margin.
  auto problem = one_axis({{.id = 1, .p_F = {0.5, -0.6}, .weight = 1.0},
                           {.id = 2, .p_F = {0.57, -0.1}, .weight = 0.4},
                           {.id = 3, .p_F = {0.66, 0.6}, .weight = 1.0}});
  auto parameters = footprint();
  parameters.kinematics = "trapezoid";
  EXPECT_DOUBLE_EQ(plan_of(parameters, problem).weight, 2.0);
  parameters.fire_while_moving = true;
  const Plan plan = plan_of(parameters, problem);
  EXPECT_DOUBLE_EQ(plan.weight, 2.4);
  ASSERT_EQ(plan.routes[0].size(), 3U);
  EXPECT_TRUE(plan.routes[0][1].moving);
  EXPECT_DOUBLE_EQ(plan.routes[0][1].depart_x_m, plan.routes[0][2].depart_x_m);
}

TEST(Footprint, FiringInPassingOnlyAdds) {
  Random random(44);
  int passing = 0;
  for (int i = 0; i < 60; ++i) {
    const auto problem = random_problem(random, 150, 1.0, 3);
    auto parameters = footprint();
    parameters.kinematics = i % 2 == 0 ? "velocity" : "trapezoid";
    parameters.dwell_s = i % 3 == 0 ? 0.01 : 0.0;
    const double at_rest = plan_of(parameters, problem).weight;
    parameters.fire_while_moving = true;
    const Plan plan = plan_of(parameters, problem);
    EXPECT_GE(plan.weight, at_rest);
    for (const auto& route : plan.routes) {
      for (const Stop& stop : route) {
        passing += stop.moving ? 1 : 0;
      }
    }
  }
  EXPECT_GT(passing, 10);
}

TEST(Footprint, AxesThatDifferKeepToTheirSpans) {
  Random random(43);
  for (int i = 0; i < 50; ++i) {
    auto problem = random_problem(random, 80, 1.0, 3);
    problem.axes[0].upper_m = 0.0;
    problem.axes[1].lower_m = -0.1;
    problem.axes[2].max_velocity_mps = 2.0;
    (void)plan_of(footprint(), problem);  // checked there
  }
}

}  // namespace
}  // namespace furrow::planning
