#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "furrow_planning/plan_checker.hpp"
#include "furrow_planning/route_planner.hpp"
#include "random_problem.hpp"

namespace furrow::planning {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Combination {
  const char* planner;
  const char* assignment;
};

constexpr Combination kAll[] = {
    {"greedy", "distance"}, {"greedy", "static"}, {"greedy", "dynamic"},     {"notsp", "distance"},
    {"notsp", "static"},    {"notsp", "dynamic"}, {"exact", "distance"},     {"exact", "static"},
    {"exact", "dynamic"},   {"greedy", "joint"},  {"permutation", "static"}, {"exact", "joint"},
    {"footprint", "joint"},
};

PlannerParameters parameters_for(const Combination& combination) {
  PlannerParameters parameters;
  parameters.planner = combination.planner;
  parameters.assignment = combination.assignment;
  return parameters;
}

/// One axis at x = 0 in the middle of its span, nothing to do.
OwnedProblem empty_problem() {
  OwnedProblem problem;
  problem.axes.resize(1);
  problem.states.resize(1);
  return problem;
}

class EveryPlanner : public testing::TestWithParam<Combination> {
 protected:
  Plan plan_of(const OwnedProblem& problem, PlannerParameters parameters) {
    Plan plan;
    EXPECT_TRUE(make_route_planner(parameters)->plan(problem.view(), plan).ok());
    const Status checked = PlanChecker(parameters).check(problem.view(), plan);
    EXPECT_TRUE(checked.ok()) << checked.error().message;
    return plan;
  }
  Plan plan_of(const OwnedProblem& problem) { return plan_of(problem, parameters_for(GetParam())); }
  void expect_refused(const OwnedProblem& problem, const std::string& part) {
    Plan plan;
    const Status status =
        make_route_planner(parameters_for(GetParam()))->plan(problem.view(), plan);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
  }
};

TEST_P(EveryPlanner, EmptyWindowIsAnEmptyPlan) {
  const Plan plan = plan_of(empty_problem());
  ASSERT_EQ(plan.routes.size(), 1U);
  EXPECT_TRUE(plan.routes[0].empty());
  EXPECT_EQ(plan.weight, 0.0);
}

TEST_P(EveryPlanner, SaysWhyEachTargetIsLeft) {
  auto problem = empty_problem();
  problem.crops = {{.id = 1, .p_F = {0.5, 0.2}}};
  problem.targets = {
      {.id = 1, .p_F = {0.5, 0.0}},                  // treated
      {.id = 2, .p_F = {0.5, 0.5}},                  // at the same moment as the first
      {.id = 1, .p_F = {0.9, 0.0}},                  // the id again
      {.id = 3, .p_F = {kNan, 0.0}},                 //
      {.id = 4, .p_F = {0.5, 0.0}, .weight = -1.0},  //
      {.id = 5, .p_F = {0.7, 0.0}, .weight = kNan},  //
      {.id = 6, .p_F = {0.7, 0.0}, .weight = 0.05},  // below the threshold
      {.id = 7, .p_F = {0.7, 0.8}},                  // beyond the span
      {.id = 8, .p_F = {-0.1, 0.0}},                 // behind
      {.id = 9, .p_F = {0.502, 0.202}},              // in the zone of the crop
      {.id = 10, .p_F = {0.001, 0.6}},               // too late to reach
  };
  auto parameters = parameters_for(GetParam());
  parameters.min_weight = 0.1;
  parameters.protection_zone_mm = 5.0;
  problem.targets[0].weight = 2.0;
  const Plan plan = plan_of(problem, parameters);
  const Decision expected[] = {
      Decision::kTreat,   Decision::kUnreachable,   Decision::kDuplicate,   Decision::kInvalid,
      Decision::kInvalid, Decision::kInvalid,       Decision::kLowPriority, Decision::kOutside,
      Decision::kBehind,  Decision::kProtectedCrop, Decision::kUnreachable,
  };
  ASSERT_EQ(plan.decisions.size(), std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(plan.decisions[i].id, problem.targets[i].id);
    EXPECT_EQ(to_string(plan.decisions[i].decision), to_string(expected[i])) << i;
  }
  EXPECT_DOUBLE_EQ(plan.weight, 2.0);
}

TEST_P(EveryPlanner, AxisOutOfServiceLeavesItsTargetsOrHandsThemOn) {
  auto problem = empty_problem();
  problem.axes = {{.offset_x_m = 0.1}, {.offset_x_m = 0.0}};
  problem.states.resize(2);
  problem.targets = {{.id = 1, .p_F = {0.5, -0.3}}, {.id = 2, .p_F = {0.8, 0.3}}};
  problem.states[0].in_service = false;
  const Plan one = plan_of(problem);
  EXPECT_TRUE(one.routes[0].empty());
  EXPECT_EQ(one.decisions[0].axis, 1);
  EXPECT_EQ(one.decisions[1].axis, 1);
  problem.states[1].in_service = false;
  const Plan none = plan_of(problem);
  EXPECT_EQ(none.decisions[0].decision, Decision::kAxisFault);
  EXPECT_EQ(none.decisions[1].decision, Decision::kAxisFault);
}

TEST_P(EveryPlanner, RefusesAProblemThatIsNotSound) {
  auto problem = empty_problem();
  problem.axes.clear();
  problem.states.clear();
  expect_refused(problem, "no axis");
  problem = empty_problem();
  problem.states.clear();
  expect_refused(problem, "axis states");
  problem = empty_problem();
  problem.robot.x_m = kNan;
  expect_refused(problem, "position");
  problem = empty_problem();
  problem.states[0].position_m = kNan;
  expect_refused(problem, "axis 0");
  problem = empty_problem();
  problem.axes[0].lower_m = 1.0;
  expect_refused(problem, "axis 0");
  problem = empty_problem();
  problem.crops = {{.id = 7, .p_F = {kNan, 0.0}}};
  expect_refused(problem, "protected plant 7");
  problem = empty_problem();
  problem.targets.resize(20001);
  expect_refused(problem, "max_targets");
}

TEST_P(EveryPlanner, KeepsOutOfProtectionZones) {
  Random random(31);
  for (int i = 0; i < 60; ++i) {
    auto problem = random_problem(random, 80, 1.0, 4);
    for (int c = 0; c < 20; ++c) {
      problem.crops.push_back(
          {.id = c,
           .p_F = {problem.robot.x_m + random.uniform(0.0, 1.0), random.uniform(-0.7, 0.7)},
           .zone_m = random.uniform(0.0, 0.02)});
    }
    auto parameters = parameters_for(GetParam());
    parameters.protection_zone_mm = 10.0;
    const Plan plan = plan_of(problem, parameters);
    int left = 0;
    for (std::size_t k = 0; k < problem.targets.size(); ++k) {
      bool near = false;
      for (const ProtectedPlant& crop : problem.crops) {
        near = near || (crop.p_F - problem.targets[k].p_F).norm() < 0.035 + crop.zone_m;
      }
      left += near ? 1 : 0;
      if (plan.decisions[k].decision == Decision::kProtectedCrop) {
        EXPECT_TRUE(near);
      }
    }
    EXPECT_GT(left, 0);
  }
}

TEST_P(EveryPlanner, SamePlanFromTheSamePlannerAgain) {
  Random random(32);
  const auto first = random_problem(random, 90, 1.0, 4);
  const auto second = random_problem(random, 40, 1.0, 3);
  const auto planner = make_route_planner(parameters_for(GetParam()));
  Plan fresh;
  Plan used;
  ASSERT_TRUE(planner->plan(first.view(), fresh).ok());
  ASSERT_TRUE(planner->plan(second.view(), used).ok());
  ASSERT_TRUE(planner->plan(first.view(), used).ok());
  EXPECT_EQ(fresh.treated, used.treated);
  EXPECT_EQ(fresh.weight, used.weight);
  EXPECT_EQ(fresh.travel_m, used.travel_m);
}

INSTANTIATE_TEST_SUITE_P(Planners, EveryPlanner, testing::ValuesIn(kAll), [](const auto& given) {
  return std::string(given.param.planner) + "_" + given.param.assignment;
});

TEST(Factory, RefusesWhatItDoesNotHave) {
  EXPECT_THROW((void)make_route_planner(parameters_for({"notsp", "joint"})), ConfigError);
  EXPECT_THROW((void)make_route_planner(parameters_for({"footprint", "static"})), ConfigError);
  EXPECT_THROW((void)make_route_planner(parameters_for({"best", "joint"})), ConfigError);
  auto parameters = parameters_for({"exact", "joint"});
  parameters.omega = kNan;
  EXPECT_THROW((void)make_route_planner(parameters), ConfigError);
}

}  // namespace
}  // namespace furrow::planning
