// The planner as a component, in simulated time: routes, reasons for weeds that are left, and
// reassignment of targets when an axis fails in the row.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using furrow_msgs::msg::Plan;
using furrow_msgs::msg::Track;
using msgs::DecisionKind;
using msgs::SafetyCause;

constexpr double kSpeed_mps = 0.5;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> kAxes = {"axis_1", "axis_2", "axis_3", "axis_4"};

/// The inputs of the planner over time, and its output.
struct World {
  double seconds = 1.0;
  bool follow = false;        ///< the robot follows the speed requests
  std::vector<Track> tracks;  ///< published while they are in view
  std::function<bool(const std::string&, double)> faulty = [](const auto&, double) {
    return false;
  };
  std::vector<Plan> plans;
  std::vector<geometry_msgs::msg::TwistStamped> speed_requests;

  /// The last decision about each track.
  [[nodiscard]] std::map<std::int64_t, furrow_msgs::msg::Decision> decisions() const {
    std::map<std::int64_t, furrow_msgs::msg::Decision> last;
    for (const Plan& plan : plans) {
      for (const auto& decision : plan.decisions()) last[decision.track_id()] = decision;
    }
    return last;
  }
};

Track weed(std::int64_t id, double x_m, double y_m, const std::string& species = "thistle") {
  Track track;
  track.id(id);
  track.state(msgs::to_msg(msgs::TrackState::kConfirmed));
  track.confirmed(true);
  track.position(to_point(Eigen::Vector2d(x_m, y_m)));
  track.area_mm2(500.0);
  track.radius_m(0.015);
  track.species().resize(1);
  track.species()[0].species(species);
  track.species()[0].crop(species == "sugar_beet");
  track.species()[0].probability(1.0F);
  return track;
}

Track crop(std::int64_t id, double x_m, double y_m) {
  Track track = weed(id, x_m, y_m, "sugar_beet");
  track.crop_probability(0.95);
  return track;
}

class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, World& world)
      : world_(world),
        tracks_out_(context.output<topics::Tracks>()),
        odometry_out_(context.output<topics::RobotOdometry>()),
        axis_out_(context.output<topics::AxisState>()) {
    context.every(Duration::milliseconds(10), [this, &context](Time now) {
      x_m_ = world_.follow ? x_m_ + 0.01 * speed_mps_ : kSpeed_mps * now.to_seconds();
      odometry_out_.publish(
          to_msg(BaseOdometry{now, {x_m_, 0.0, 0.0}, speed_mps_, 0.0}, kFieldFrame));
      if (now.to_seconds() >= world_.seconds) context.request_stop("finished");
    });
    context.every(Duration::milliseconds(100), [this](Time now) { show(now); });
    context.input<topics::Plan>([this](const auto& plan) { world_.plans.push_back(*plan); });
    context.input<topics::SpeedRequest>([this](const auto& request) {
      world_.speed_requests.push_back(*request);
      if (world_.follow) speed_mps_ = request->twist().linear().x();
    });
  }

  static void describe(graph::Description& d) {
    d.input<topics::Plan>()
        .input<topics::SpeedRequest>()
        .output<topics::Tracks>()
        .output<topics::RobotOdometry>()
        .output<topics::AxisState>();
  }

 private:
  void show(Time now) {
    for (const std::string& axis : kAxes) {
      furrow_msgs::msg::AxisState state;
      state.header(header(now, ""));
      state.axis(axis);
      const bool faulty = world_.faulty(axis, now.to_seconds());
      state.cause(msgs::to_msg(faulty ? SafetyCause::kFollowingError : SafetyCause::kNone));
      axis_out_.publish(std::move(state));
    }
    furrow_msgs::msg::Tracks message;
    message.header(header(now, kFieldFrame));
    for (const Track& track : world_.tracks) {
      const double ahead_m = track.position().x() - x_m_;
      if (!(ahead_m < -1.0 || ahead_m > 1.75)) message.tracks().push_back(track);
    }
    tracks_out_.publish(std::move(message));
  }

  World& world_;
  double x_m_ = 0.0;
  double speed_mps_ = kSpeed_mps;
  graph::Output<topics::Tracks> tracks_out_;
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::AxisState> axis_out_;
};

/// Returns the health of the planner at the end.
graph::Health run(World& world, const std::map<std::string, ParameterValue>& parameters = {}) {
  graph::Registry registry;
  registry.load_library(FURROW_PLANNER_LIBRARY);
  registry.add(feeder_class<Feeder>(world));
  graph::GraphSpec spec;
  spec.components = {{.name = "planner",
                      .group = "planner",
                      .class_name = "planner",
                      .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  for (const auto& [name, value] : parameters) {
    spec.components[0].parameters.push_back({name, value, {}});
  }
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
  return runtime.status()[0].health;
}

std::set<std::int64_t> targets_of(const Plan& plan, const std::string& axis) {
  std::set<std::int64_t> ids;
  for (const auto& route : plan.routes()) {
    if (route.axis() != axis) continue;
    for (const auto& stop : route.stops()) {
      ids.insert(stop.track_ids().begin(), stop.track_ids().end());
    }
  }
  return ids;
}

TEST(PlannerComponent, TargetsOfAFailedAxisAreReassigned) {
  constexpr double kFault_s = 4.05;
  World world;
  world.seconds = 10.0;
  for (int i = 0; i < 60; ++i) {
    world.tracks.push_back(weed(i + 1, 0.6 + 0.07 * i, 0.23 * (i * 7 % 6) - 0.575));
  }
  world.faulty = [&](const std::string& axis, double t_s) {
    return axis == "axis_2" && t_s >= kFault_s;
  };
  run(world);
  const Plan* before = nullptr;
  const Plan* after = nullptr;
  for (const Plan& plan : world.plans) {
    const double at_s = graph::from_msg(plan.header().stamp()).to_seconds();
    if (at_s < kFault_s) before = &plan;
    // The fault arrives with the next frame; the plan is of that frame or the one after.
    if (at_s < kFault_s + 0.15) continue;
    EXPECT_TRUE(targets_of(plan, "axis_2").empty()) << "at " << at_s << " s";
    if (after == nullptr) after = &plan;
  }
  ASSERT_NE(before, nullptr);
  ASSERT_NE(after, nullptr);
  const auto left = targets_of(*before, "axis_2");
  ASSERT_FALSE(left.empty());
  std::set<std::int64_t> by_others;
  for (const char* axis : {"axis_1", "axis_3", "axis_4"}) by_others.merge(targets_of(*after, axis));
  std::size_t reassigned = 0;
  for (const std::int64_t id : left) reassigned += by_others.count(id);
  EXPECT_GE(reassigned + 1, left.size()) << "except one that was committed";
  const auto decisions = world.decisions();
  for (const Track& track : world.tracks) {
    ASSERT_TRUE(decisions.contains(track.id()));
    const auto& decision = decisions.at(track.id());
    // Nozzle 2 is at x +0.06 m: targets ahead of it at the fault go to other axes.
    if (track.position().x() < kSpeed_mps * kFault_s + 0.3) continue;
    EXPECT_TRUE(decision.decision() == DecisionKind::kTreat) << track.id();
    EXPECT_NE(decision.axis(), "axis_2") << track.id();
  }
}

TEST(PlannerComponent, WithAllAxesFailedEveryTargetIsLeftForAFault) {
  World world;
  world.seconds = 3.0;
  world.tracks = {weed(1, 0.8, 0.0), weed(2, 1.0, 0.3)};
  world.faulty = [](const auto&, double) { return true; };
  run(world);
  const auto decisions = world.decisions();
  ASSERT_EQ(decisions.size(), 2U);
  EXPECT_TRUE(decisions.at(1).decision() == DecisionKind::kFault);
  EXPECT_TRUE(decisions.at(2).decision() == DecisionKind::kFault);
}

TEST(PlannerComponent, EveryWeedThatIsLeftHasAReason) {
  World world;
  world.seconds = 1.0;
  world.tracks = {weed(1, 0.9, 0.0),  weed(2, 0.9, 1.2),
                  weed(3, -0.5, 0.1), weed(4, 1.1, 0.2, "chickweed"),
                  weed(5, 1.3, 0.4),  crop(6, 1.301, 0.4)};
  run(world, {{"harmfulness_left_standing_below", 0.5}, {"protection_zone_mm", 20.0}});
  const std::map<std::int64_t, std::string> expected = {
      {1, "treat"}, {2, "outside"}, {3, "unreachable"}, {4, "low_priority"}, {5, "protected_crop"}};
  std::map<std::int64_t, std::string> found;
  for (const auto& [id, decision] : world.decisions())
    found[id] = msgs::to_string(decision.decision());
  EXPECT_EQ(found, expected);
}

TEST(PlannerComponent, SaysWhatAWeedIsWorthAndWhy) {
  World world;
  world.seconds = 1.0;
  // Two thirds thistle (beta 1), one third speedwell (beta 0.2) given that it is a weed.
  Track unsure_species = weed(1, 0.9, 0.0);
  unsure_species.species().resize(3);
  const std::vector<std::pair<std::string, float>> shares = {
      {"thistle", 0.4F}, {"sugar_beet", 0.4F}, {"speedwell", 0.2F}};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    unsure_species.species()[i].species(shares[i].first);
    unsure_species.species()[i].crop(shares[i].first == "sugar_beet");
    unsure_species.species()[i].probability(shares[i].second);
  }
  unsure_species.leaves(4);
  Track beet = crop(2, 0.9, 0.2);
  beet.area_mm2(2000.0);
  world.tracks = {unsure_species, beet};
  run(world, {{"harmfulness_scheme", std::string("kappa")}});
  const auto appraisal = world.decisions().at(1).appraisal();
  ASSERT_TRUE(appraisal.valid());
  EXPECT_EQ(appraisal.species(), "thistle");
  EXPECT_NEAR(appraisal.species_probability(), 2.0 / 3.0, 1e-6);
  EXPECT_NEAR(appraisal.unknown_probability(), 0.0, 1e-6);
  EXPECT_NEAR(appraisal.beta(), (2.0 * 1.0 + 0.2) / 3.0, 1e-6);
  EXPECT_EQ(appraisal.leaves(), 4);
  EXPECT_DOUBLE_EQ(appraisal.crop_distance_m(), 0.2);
  EXPECT_DOUBLE_EQ(appraisal.crop_proximity(), 1.0 / (2000.0 * 0.2));
  EXPECT_DOUBLE_EQ(appraisal.worth(), 500.0 * appraisal.beta() * appraisal.crop_proximity());
}

TEST(PlannerComponent, NeitherTreatsNorForgetsAPlantThatMayBeACrop) {
  World world;
  world.seconds = 1.0;
  world.tracks = {weed(1, 0.9, 0.0), weed(2, 0.9, 0.3), weed(3, 0.901, 0.3)};
  world.tracks[1].crop_probability(0.4);
  run(world, {{"protection_zone_mm", 20.0}});
  const auto decisions = world.decisions();
  EXPECT_TRUE(decisions.at(1).decision() == DecisionKind::kTreat);
  EXPECT_TRUE(decisions.at(2).decision() == DecisionKind::kUnsure);
  EXPECT_TRUE(decisions.at(3).decision() == DecisionKind::kProtectedCrop);
  EXPECT_FALSE(decisions.at(2).appraisal().valid());
}

TEST(PlannerComponent, InvalidTracksDoNotAffectOthers) {
  World world;
  world.tracks = {weed(1, 0.9, 0.0), weed(2, kNan, 0.0), weed(3, 1.0, 0.3), crop(4, 0.95, kNan),
                  weed(1, 0.9, 0.0)};
  world.tracks[2].area_mm2(-5.0);
  Track bad_crop = crop(5, 0.8, -0.5);
  bad_crop.area_mm2(kNan);
  world.tracks.push_back(bad_crop);
  run(world,
      {{"harmfulness_scheme", std::string("kappa")}, {"harmfulness_crops", std::string("all")}});
  const auto decisions = world.decisions();
  EXPECT_TRUE(decisions.at(1).decision() == DecisionKind::kTreat);
  EXPECT_TRUE(decisions.at(2).decision() == DecisionKind::kStale);
  EXPECT_TRUE(decisions.at(3).decision() == DecisionKind::kStale);
  std::size_t treats = 0;
  for (const std::string& axis : kAxes) treats += targets_of(world.plans.back(), axis).count(1);
  EXPECT_EQ(treats, 1U) << "given twice, treated once";
}

TEST(PlannerComponent, CountsUnknownValuesAndTreatsNoWeedOfAnUnknownState) {
  constexpr std::uint8_t kUnknown = 200;
  World world;
  world.tracks = {weed(1, 0.9, 0.0), weed(2, 1.0, 0.3), crop(3, 1.1, -0.4), weed(4, 1.101, -0.4)};
  world.tracks[1].state().value(kUnknown);
  world.tracks[2].state().value(kUnknown);
  const graph::Health health = run(world, {{"protection_zone_mm", 20.0}});
  const auto decisions = world.decisions();
  EXPECT_TRUE(decisions.at(1).decision() == DecisionKind::kTreat);
  EXPECT_FALSE(decisions.contains(2));
  EXPECT_TRUE(decisions.at(4).decision() == DecisionKind::kProtectedCrop)
      << "a crop of an unknown state stays protected";
  EXPECT_GE(health.counters.at("unknown_values"), 2);
}

TEST(PlannerComponent, TreatsUnconfirmedWeedsOnRequest) {
  for (const bool asked : {false, true}) {
    World world;
    world.tracks = {weed(1, 0.9, 0.0), weed(2, 1.0, 0.3)};
    world.tracks[1].confirmed(false);
    run(world, {{"treat_unconfirmed", asked}});
    const auto decisions = world.decisions();
    EXPECT_TRUE(decisions.at(1).decision() == DecisionKind::kTreat);
    EXPECT_EQ(decisions.contains(2), asked);
    if (asked) {
      EXPECT_TRUE(decisions.at(2).decision() == DecisionKind::kTreat);
    }
  }
}

/// Weeds in a line across the row: four axes reach them all at a low speed only.
std::vector<Track> line_across(double x_m) {
  std::vector<Track> weeds;
  for (int i = 0; i < 11; ++i) weeds.push_back(weed(i + 1, x_m + 0.003 * i, 0.12 * (i - 5)));
  return weeds;
}

TEST(PlannerComponent, RequestsNoSpeedUnlessItGoverns) {
  World world;
  world.seconds = 3.0;
  world.tracks = line_across(3.0);
  run(world, {{"kinematics", std::string("trapezoid")}});
  EXPECT_TRUE(world.speed_requests.empty());
}

TEST(PlannerComponent, RequestsALowerSpeedForWeedsThatTheAxesWouldNotReach) {
  const std::map<std::string, ParameterValue> parameters = {
      {"govern_speed", true},
      {"kinematics", std::string("trapezoid")},
      {"governor_min_speed_mps", 0.1},
      {"governor_acceleration_mps2", 0.3}};
  World world;
  world.seconds = 12.0;
  world.follow = true;
  world.tracks = line_across(2.0);
  run(world, parameters);
  ASSERT_FALSE(world.speed_requests.empty());
  double before_mps = kSpeed_mps;
  double least_mps = kSpeed_mps;
  for (const auto& request : world.speed_requests) {
    const double asked_mps = request.twist().linear().x();
    EXPECT_EQ(request.header().frame_id(), kBaseFrame);
    EXPECT_GE(asked_mps, 0.1 - 1e-9);
    EXPECT_LE(asked_mps, kSpeed_mps + 1e-9);
    EXPECT_LE(std::abs(asked_mps - before_mps), 1.2 * 0.3 * 0.02) << "at 50 Hz";
    before_mps = asked_mps;
    least_mps = std::min(least_mps, asked_mps);
  }
  EXPECT_LT(least_mps, 0.4);
  EXPECT_EQ(world.speed_requests.front().twist().linear().x(), kSpeed_mps);
  EXPECT_NEAR(world.speed_requests.back().twist().linear().x(), kSpeed_mps, 1e-9)
      << "the weeds are past";
  for (const auto& [id, decision] : world.decisions()) {
    EXPECT_TRUE(decision.decision() == DecisionKind::kTreat) << id;
  }

  // A robot that ignores the requests still gets them; the plan uses its real speed.
  world.follow = false;
  world.plans.clear();
  run(world, parameters);
  int left = 0;
  for (const auto& [id, decision] : world.decisions()) {
    left += decision.decision() == DecisionKind::kUnreachable ? 1 : 0;
  }
  EXPECT_GT(left, 0);
}

TEST(PlannerComponent, RefusesParametersThatContradictEachOther) {
  World world;
  EXPECT_THROW(run(world, {{"govern_speed", true}, {"view", std::string("segment")}}), ConfigError);
  EXPECT_THROW(run(world, {{"govern_speed", true}, {"fire_while_moving", true}}), ConfigError);
  EXPECT_THROW(run(world, {{"unsure_threshold", 0.6}}), ConfigError);
}

TEST(PlannerComponent, NoTracksGiveAnEmptyPlan) {
  World world;
  run(world);
  ASSERT_FALSE(world.plans.empty());
  EXPECT_TRUE(world.decisions().empty());
  for (const std::string& axis : kAxes) {
    EXPECT_TRUE(targets_of(world.plans.back(), axis).empty());
  }
}

}  // namespace
}  // namespace furrow::components
