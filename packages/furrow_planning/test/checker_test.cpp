#include <gtest/gtest.h>

#include <functional>

#include "furrow_planning/plan_checker.hpp"
#include "furrow_planning/route_planner.hpp"
#include "random_problem.hpp"

namespace furrow::planning {
namespace {

class Checker : public testing::Test {
 protected:
  Checker() {
    parameters_.planner = "exact";
    problem_.axes.resize(2);
    problem_.states.resize(2);
    problem_.targets = {
        {.id = 1, .p_F = {0.5, 0.0}}, {.id = 2, .p_F = {0.6, 0.3}}, {.id = 3, .p_F = {0.5, 0.5}}};
    problem_.crops = {{.id = 9, .p_F = {0.9, 0.0}}};
    EXPECT_TRUE(make_route_planner(parameters_)->plan(problem_.view(), plan_).ok());
    EXPECT_EQ(plan_.weight, 3.0);
  }

  /// Spoils the plan, and expects the checker to say so.
  void expect_found(const std::function<void(Plan&)>& spoil, const std::string& part) {
    Plan plan = plan_;
    spoil(plan);
    const Status status = PlanChecker(parameters_).check(problem_.view(), plan);
    ASSERT_FALSE(status.ok()) << part;
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
  }
  Stop& some_stop(Plan& plan) { return plan.routes[plan.routes[0].empty() ? 1 : 0].back(); }
  void shift(Stop& stop, double dx, double dy) {
    stop.aim_F += Eigen::Vector2d(dx, dy);
    stop.robot_x_m += dx;
    stop.position_m += dy;
  }

  PlannerParameters parameters_;
  OwnedProblem problem_;
  Plan plan_;
};

TEST_F(Checker, AcceptsAGoodPlan) {
  EXPECT_TRUE(PlanChecker(parameters_).check(problem_.view(), plan_).ok());
}

TEST_F(Checker, FindsWhatIsWrong) {
  expect_found([](Plan& plan) { plan.routes.pop_back(); }, "routes and axes differ");
  expect_found([](Plan& plan) { plan.decisions.pop_back(); }, "decisions and targets differ");
  expect_found([](Plan& plan) { plan.decisions[1].id = 77; }, "another target");
  expect_found([](Plan& plan) { plan.weight += 1.0; }, "sums");
  expect_found([](Plan& plan) { plan.travel_m += 1.0; }, "sums");
  expect_found([&](Plan& plan) { some_stop(plan).robot_x_m += 0.01; }, "agree with its aim");
  expect_found([&](Plan& plan) { shift(some_stop(plan), 0.03, 0.0); }, "outside the footprint");
  expect_found([&](Plan& plan) { shift(some_stop(plan), 0.0, 2.0); }, "outside the axis's span");
  expect_found([&](Plan& plan) { shift(some_stop(plan), -0.6, 0.0); }, "in time");
  expect_found([&](Plan& plan) { some_stop(plan).target_count = 0; }, "treats no target");
  expect_found([&](Plan& plan) { some_stop(plan).first_target = 99; }, "treats no target");
  expect_found([](Plan& plan) { plan.treated[0] = 55; }, "not given");
  expect_found([](Plan& plan) { plan.treated[1] = plan.treated[0]; }, "twice");
  expect_found([](Plan& plan) { plan.decisions[0].decision = Decision::kUnreachable; },
               "against its decision");
  expect_found([](Plan& plan) { plan.decisions[0].axis ^= 1; }, "against its decision");
}

TEST_F(Checker, FindsStopsThatFollowTooSoon) {
  // Both targets of the first 0.1 m on one axis: the second is 0.5 m aside of the first.
  Plan plan = plan_;
  for (auto& route : plan.routes) {
    route.clear();
  }
  plan.routes[0] = {{.aim_F = {0.5, 0.0}, .robot_x_m = 0.5, .first_target = 0, .target_count = 1},
                    {.aim_F = {0.5, 0.5},
                     .robot_x_m = 0.5,
                     .position_m = 0.5,
                     .first_target = 1,
                     .target_count = 1}};
  plan.treated = {1, 3};
  const Status status = PlanChecker(parameters_).check(problem_.view(), plan);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("in time"), std::string::npos);
}

TEST_F(Checker, FindsZonesAndAxesOutOfService) {
  problem_.crops[0].p_F = {0.5, 0.02};
  expect_found([](Plan&) {}, "protection zone of plant 9");
  problem_.crops.clear();
  problem_.states[0].in_service = false;
  problem_.states[1].in_service = false;
  expect_found([](Plan&) {}, "out of service");
}

}  // namespace
}  // namespace furrow::planning
