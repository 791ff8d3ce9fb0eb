#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "furrow_core/random.hpp"
#include "furrow_planning/observation_view.hpp"
#include "stream_field.hpp"

namespace furrow::planning {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Drives over the field; `at_frame` is called before each replan. Returns each target's outcome.
template <class AtFrame>
std::map<TargetId, TargetOutcome> drive(ObservationView& view, const std::vector<Target>& targets,
                                        double length_m, const AtFrame& at_frame) {
  std::map<TargetId, TargetOutcome> all;
  std::set<TargetId> known;
  for (double x = -1.2; x < length_m + 0.5; x += 0.05) {
    EXPECT_TRUE(view.advance({.x_m = x}, x + 1.2).ok());
    for (const Target& target : targets) {
      if (target.p_F.x() < x + 1.2 && known.insert(target.id).second) {
        EXPECT_TRUE(view.update(target).ok());
      }
    }
    at_frame(x);
    const auto replanned = view.replan();
    EXPECT_TRUE(replanned.ok()) << replanned.error().message;
    std::vector<TargetOutcome> outcomes;
    view.take_outcomes(outcomes);
    for (const TargetOutcome& outcome : outcomes) {
      EXPECT_TRUE(all.emplace(outcome.id, outcome).second) << "reported twice";
    }
  }
  return all;
}

double loss(const std::map<TargetId, TargetOutcome>& outcomes) {
  const auto treated = std::count_if(outcomes.begin(), outcomes.end(), [](const auto& entry) {
    return entry.second.decision == Decision::kTreat;
  });
  return 1.0 - static_cast<double>(treated) / static_cast<double>(outcomes.size());
}

class BothViews : public testing::TestWithParam<const char*> {};

TEST_P(BothViews, EachTargetIsReportedOnce) {
  for (const auto& [planner, assignment] :
       {std::pair{"exact", "joint"}, std::pair{"exact", "static"}, std::pair{"notsp", "static"},
        std::pair{"footprint", "joint"}}) {
    const auto view =
        make_observation_view(parameters_for(GetParam(), planner, assignment), axes(4));
    const auto targets = field(20.0, 4.0, 3);
    const auto outcomes = drive(*view, targets, 4.0, [](double) {});
    EXPECT_EQ(outcomes.size(), targets.size());
    EXPECT_LT(loss(outcomes), 0.4);
    for (const Target& target : targets) {
      const TargetOutcome& outcome = outcomes.at(target.id);
      if (outcome.decision == Decision::kTreat) {
        EXPECT_LT((outcome.aim_F - target.p_F).norm(), 0.025 + 1e-9);
        EXPECT_GE(outcome.axis, 0);
      }
    }
  }
}

TEST_P(BothViews, FailedAxisHandsItsTargetsOn) {
  const auto view = make_observation_view(parameters_for(GetParam()), axes(4));
  const auto targets = field(8.0, 6.0, 4);
  const auto outcomes = drive(*view, targets, 6.0, [&](double x) {
    if (x > 3.0) {
      EXPECT_TRUE(view->set_in_service(1, false).ok());
    }
  });
  EXPECT_EQ(outcomes.size(), targets.size());
  int treated_after = 0;
  for (const Target& target : targets) {
    const TargetOutcome& outcome = outcomes.at(target.id);
    // Axis 1 stands at +0.06: what it sprayed before its failure lies behind 3.1 m.
    if (outcome.decision == Decision::kTreat && target.p_F.x() > 3.15) {
      EXPECT_NE(outcome.axis, 1);
      ++treated_after;
    }
  }
  EXPECT_GT(treated_after, 15);
  EXPECT_LT(loss(outcomes), 0.2);
}

TEST_P(BothViews, AllAxesFailedIsAFault) {
  const auto view = make_observation_view(parameters_for(GetParam()), axes(2));
  ASSERT_TRUE(view->set_in_service(0, false).ok());
  ASSERT_TRUE(view->set_in_service(1, false).ok());
  const auto targets = field(5.0, 2.0, 5);
  for (const auto& [id, outcome] : drive(*view, targets, 2.0, [](double) {})) {
    EXPECT_EQ(outcome.decision, Decision::kAxisFault);
  }
}

TEST_P(BothViews, ARobotThatStandsOrReversesKeepsItsPlan) {
  const auto view = make_observation_view(parameters_for(GetParam()), axes(2));
  const auto targets = field(4.0, 2.0, 5);
  for (const Target& target : targets) ASSERT_TRUE(view->update(target).ok());
  double x_m = 0.0;
  for (; x_m < 1.0; x_m += 0.05) {
    ASSERT_TRUE(view->advance({.x_m = x_m}, x_m + 1.2).ok());
    ASSERT_TRUE(view->replan().ok());
  }
  std::vector<TargetOutcome> outcomes;
  view->take_outcomes(outcomes);
  outcomes.clear();
  const std::size_t stops = view->plan().routes[0].size() + view->plan().routes[1].size();
  ASSERT_GT(stops, 0u);
  for (const double back_m : {0.0, 0.003, 0.001, 0.3, 2.0, 1.0, 0.001}) {
    ASSERT_TRUE(view->advance({.x_m = x_m - 0.05 - back_m, .speed_mps = -0.1}, 1.0).ok());
    ASSERT_TRUE(view->replan().ok());
    EXPECT_EQ(view->plan().routes[0].size() + view->plan().routes[1].size(), stops) << back_m;
  }
  view->take_outcomes(outcomes);
  EXPECT_TRUE(outcomes.empty());
}

TEST(StandingRobot, WithTheMeasuredSpeedPlansHoldForItsLastSpeed) {
  PlannerParameters parameters = parameters_for("rolling");
  parameters.speed_source = "measured";
  const auto view = make_observation_view(parameters, axes(2));
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.9, 0.1}}).ok());
  ASSERT_TRUE(view->advance({.x_m = 0.0, .speed_mps = 0.4}, 1.0).ok());
  ASSERT_TRUE(view->replan().ok());
  const double depart_x_m = view->plan().routes[0].size() == 1
                                ? view->plan().routes[0][0].depart_x_m
                                : view->plan().routes[1][0].depart_x_m;
  ASSERT_TRUE(view->advance({.x_m = 0.001, .speed_mps = 0.0}, 1.0).ok());
  ASSERT_TRUE(view->update({.id = 2, .p_F = {3.0, 0.1}}).ok());
  ASSERT_TRUE(view->replan().ok());
  const Plan& plan = view->plan();
  bool found = false;
  for (const auto& route : plan.routes) {
    for (const Stop& stop : route) found = found || std::abs(stop.depart_x_m - depart_x_m) < 0.01;
  }
  EXPECT_TRUE(found);
}

TEST(ReversingRobot, ATreatedPlantUnderANewIdIsNotPlannedAgain) {
  const auto view = make_observation_view(parameters_for("rolling"), axes(2));
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.9, 0.1}}).ok());
  for (double x_m = 0.0; x_m < 1.2; x_m += 0.02) {
    ASSERT_TRUE(view->advance({.x_m = x_m}, x_m + 1.0).ok());
    ASSERT_TRUE(view->replan().ok());
  }
  ASSERT_TRUE(view->advance({.x_m = 0.2, .speed_mps = -0.3}, 1.0).ok());
  ASSERT_TRUE(view->update({.id = 77, .p_F = {0.905, 0.1}}).ok());
  ASSERT_TRUE(view->replan().ok());
  std::vector<TargetOutcome> outcomes;
  view->take_outcomes(outcomes);
  const auto again = std::ranges::find(outcomes, 77, &TargetOutcome::id);
  ASSERT_NE(again, outcomes.end());
  EXPECT_EQ(again->decision, Decision::kDuplicate);
}

TEST_P(BothViews, BadInputIsAnError) {
  const auto view = make_observation_view(parameters_for(GetParam()), axes(2));
  EXPECT_FALSE(view->replan().ok());  // the robot's place is not known yet
  EXPECT_FALSE(view->advance({.x_m = kNan}, 1.0).ok());
  ASSERT_TRUE(view->advance({.x_m = 0.0}, 1.0).ok());
  EXPECT_FALSE(view->update({.id = 1, .p_F = {kNan, 0.0}}).ok());
  EXPECT_FALSE(view->update({.id = 2, .p_F = {0.5, 0.0}, .weight = -1.0}).ok());
  EXPECT_FALSE(view->update_protected({.id = 1, .p_F = {0.5, kNan}}).ok());
  EXPECT_FALSE(view->set_in_service(2, false).ok());
  EXPECT_FALSE(view->set_axis_position(0, kNan).ok());
  EXPECT_FALSE(view->remove(42));
  EXPECT_FALSE(view->remove_protected(42));
  std::vector<TargetOutcome> outcomes;
  view->take_outcomes(outcomes);
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_EQ(outcomes[0].decision, Decision::kInvalid);
  EXPECT_EQ(outcomes[1].decision, Decision::kInvalid);
  EXPECT_TRUE(view->replan().ok());
}

INSTANTIATE_TEST_SUITE_P(Views, BothViews, testing::Values("rolling", "segment"));

TEST(RollingView, PlansOnlyWhenSomethingChanged) {
  const auto view = make_observation_view(parameters_for("rolling"), axes(4));
  ASSERT_TRUE(view->advance({.x_m = 0.0}, 1.0).ok());
  EXPECT_TRUE(view->replan().value());
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.8, 0.1}}).ok());
  EXPECT_TRUE(view->replan().value());
  EXPECT_FALSE(view->replan().value());
  ASSERT_TRUE(view->advance({.x_m = 0.05}, 1.05).ok());
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.8, 0.1}}).ok());
  EXPECT_FALSE(view->replan().value());
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.8, 0.15}}).ok());
  EXPECT_TRUE(view->replan().value());
  EXPECT_EQ(view->plan().decisions.at(0).decision, Decision::kTreat);
  EXPECT_TRUE(view->remove(1));
  EXPECT_TRUE(view->replan().value());
  EXPECT_TRUE(view->plan().decisions.empty());
}

TEST(RollingView, KeepsCommittedStops) {
  auto parameters = parameters_for("rolling");
  parameters.commit_s = 0.2;
  const auto view = make_observation_view(parameters, axes(1));
  ASSERT_TRUE(view->advance({.x_m = 0.0}, 1.0).ok());
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.3, 0.1}}).ok());
  ASSERT_TRUE(view->replan().ok());
  const Stop stop = view->plan().routes[0].at(0);
  // The axis moves by 0.1 m in 20 ms and keeps a margin of ln(0.6 / 0.4) / 20 s.
  EXPECT_NEAR(stop.depart_x_m, 0.3 - 0.5 * (0.02 + std::log(1.5) / 20.0), 1e-9);
  ASSERT_TRUE(view->advance({.x_m = stop.depart_x_m - 0.09}, 1.2).ok());
  // Worth far more, but at the same moment on the other side: too late to change.
  ASSERT_TRUE(view->update({.id = 2, .p_F = {0.3, -0.6}, .weight = 50.0}).ok());
  ASSERT_TRUE(view->update({.id = 1, .p_F = {0.35, 0.2}}).ok());
  EXPECT_FALSE(view->remove(1));
  ASSERT_TRUE(view->replan().ok());
  ASSERT_EQ(view->plan().routes[0].size(), 1U);
  EXPECT_EQ(view->plan().routes[0][0].aim_F, stop.aim_F);
  ASSERT_TRUE(view->advance({.x_m = 1.0}, 2.0).ok());
  std::vector<TargetOutcome> outcomes;
  view->take_outcomes(outcomes);
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_EQ(outcomes[0].decision, Decision::kTreat);
  EXPECT_EQ(outcomes[1].decision, Decision::kUnreachable);
  EXPECT_NEAR(view->travel_m()[0], 0.1, 1e-9);
}

TEST(RollingView, LosesNoMoreThanSegmentsOnAverage) {
  double rolling = 0.0;
  double segment = 0.0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto targets = field(20.0, 6.0, 50 + seed);
    const auto roll = make_observation_view(parameters_for("rolling"), axes(4));
    const auto steps = make_observation_view(parameters_for("segment"), axes(4));
    rolling += loss(drive(*roll, targets, 6.0, [](double) {}));
    segment += loss(drive(*steps, targets, 6.0, [](double) {}));
  }
  EXPECT_LE(rolling, segment + 1e-9);
}

TEST(RollingView, SurvivesRandomEvents) {
  Random random(6);
  for (int run = 0; run < 10; ++run) {
    const auto view = make_observation_view(
        parameters_for(run % 2 == 0 ? "rolling" : "segment", run < 5 ? "exact" : "footprint"),
        axes(3));
    double x = 0.0;
    for (int step = 0; step < 400; ++step) {
      x += random.uniform(0.0, 0.05);
      ASSERT_TRUE(view->advance({.x_m = x, .y_m = random.uniform(-0.01, 0.01)}, x + 1.0).ok());
      for (int i = 0; i < 3; ++i) {
        const auto id = random.integer(0, 500);
        (void)view->update({.id = id,
                            .p_F = {x + random.uniform(-0.3, 1.0), random.uniform(-0.8, 0.8)},
                            .weight = random.uniform(0.0, 2.0)});
      }
      (void)view->remove(random.integer(0, 500));
      (void)view->update_protected(
          {.id = random.integer(0, 50), .p_F = {x + random.uniform(0.0, 1.0), 0.0}});
      (void)view->set_in_service(static_cast<std::size_t>(random.integer(0, 2)),
                                 random.bernoulli(0.9));
      const auto replanned = view->replan();  // also checks the plan
      ASSERT_TRUE(replanned.ok()) << replanned.error().message;
    }
  }
}

TEST(View, RefusesBadConfiguration) {
  EXPECT_THROW((void)make_observation_view(parameters_for("sideways"), axes(1)), ConfigError);
  EXPECT_THROW((void)make_observation_view(parameters_for("rolling"), {}), ConfigError);
  EXPECT_THROW(
      (void)make_observation_view(parameters_for("rolling"), {{.lower_m = 1.0, .upper_m = 0.0}}),
      ConfigError);
}

}  // namespace
}  // namespace furrow::planning
