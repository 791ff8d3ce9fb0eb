// Tracker and planner in simulated time, while odometry or images fail. Unusable input is counted
// and shown by the health, and the planner treats no stale targets.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
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
using nav_msgs::msg::Odometry;

constexpr double kSpeed_mps = 0.5;
constexpr double kFault_s = 2.0;  ///< start of the fault
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The inputs of the tracker while the robot passes six weeds, and the results.
struct World {
  double seconds = 5.0;
  /// Called for each message after kFault_s; false: it is not sent.
  std::function<bool(Odometry&)> spoil = [](Odometry&) { return true; };
  std::function<bool(furrow_msgs::msg::PlantInstances&)> spoil_images = [](auto&) { return true; };
  std::vector<furrow_msgs::msg::Tracks> tracks;
  std::vector<furrow_msgs::msg::Plan> plans;
  std::map<std::string, graph::Health> last;  ///< by component, at the end of the run

  [[nodiscard]] std::int64_t counter(const std::string& component, const std::string& name) const {
    const auto& counters = last.at(component).counters;
    const auto found = counters.find(name);
    return found == counters.end() ? 0 : found->second;
  }
  [[nodiscard]] double newest_stamp_s() const {
    return graph::from_msg(tracks.back().header().stamp()).to_seconds();
  }
  [[nodiscard]] bool decided(msgs::DecisionKind kind) const {
    for (const auto& plan : plans) {
      for (const auto& decision : plan.decisions()) {
        if (decision.decision() == kind) return true;
      }
    }
    return false;
  }
};

class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, World& world)
      : world_(world),
        odometry_out_(context.output<topics::RobotOdometry>()),
        instances_out_(context.output<topics::Instances>()) {
    context.every(Duration::milliseconds(10), [this, &context](Time now) {
      Odometry odometry =
          to_msg(BaseOdometry{now, {kSpeed_mps * now.to_seconds(), 0.0, 0.0}, kSpeed_mps, 0.0},
                 kFieldFrame);
      for (const std::size_t i : {0, 7, 35}) odometry.pose().covariance()[i] = 1e-6;
      const bool sent = now.to_seconds() < kFault_s || world_.spoil(odometry);
      if (sent) odometry_out_.publish(std::move(odometry));
      if (now.to_seconds() >= world_.seconds) context.request_stop("finished");
    });
    context.every(Duration::milliseconds(200), [this](Time now) { show(now); });
    context.input<topics::Tracks>([this](const auto& tracks) { world_.tracks.push_back(*tracks); });
    context.input<topics::Plan>([this](const auto& plan) { world_.plans.push_back(*plan); });
  }

  static void describe(graph::Description& d) {
    d.input<topics::Tracks>()
        .input<topics::Plan>()
        .output<topics::RobotOdometry>()
        .output<topics::Instances>();
  }

 private:
  // The image centre lies 1.2 m ahead of the base. A weed that stands still in the field moves down
  // the image as the robot drives, by 870 px for each metre.
  void show(Time now) {
    furrow_msgs::msg::PlantInstances message;
    message.header(header(now, "camera"));
    for (const double x_F : {1.5, 2.0, 2.5, 3.0, 3.5, 4.0}) {
      const double ahead_m = x_F - kSpeed_mps * now.to_seconds() - 1.2;
      const double v_px = 479.5 - 870.0 * ahead_m;
      if (v_px < 20.0 || v_px > 940.0) continue;
      auto& weed = message.instances().emplace_back();
      weed.score(0.9F);
      weed.crop_probability(0.05F);
      weed.stem_u_px(639.5);
      weed.stem_v_px(v_px);
      weed.stem(to_point(Eigen::Vector3d(0.0, 0.0, 1.0)));
      weed.box().x_offset(630);
      weed.box().y_offset(static_cast<std::uint32_t>(v_px) - 10);
      weed.box().width(20);
      weed.box().height(20);
      weed.radius_m(0.012);
      weed.area_mm2(300.0);
    }
    const bool sent = now.to_seconds() < kFault_s || world_.spoil_images(message);
    if (sent) instances_out_.publish(std::move(message));
  }

  World& world_;
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::Instances> instances_out_;
};

void run(World& world) {
  graph::Registry registry;
  registry.load_library(FURROW_TRACKER_LIBRARY);
  registry.load_library(FURROW_PLANNER_LIBRARY);
  registry.add(feeder_class<Feeder>(world));
  graph::GraphSpec spec;
  for (const std::string name : {"tracker", "planner"}) {
    spec.components.push_back({.name = name,
                               .group = name,
                               .class_name = name,
                               .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}}}});
  }
  spec.components.push_back({.name = "feeder", .group = "feeder", .class_name = "feeder"});
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
  for (const auto& status : runtime.status()) world.last[status.name] = status.health;
}

TEST(TrackerComponent, ValidInputIsTreatedAndNothingIsStale) {
  World world;
  run(world);
  ASSERT_FALSE(world.tracks.empty());
  EXPECT_GT(world.newest_stamp_s(), world.seconds - 0.5);
  EXPECT_TRUE(world.decided(msgs::DecisionKind::kTreat));
  EXPECT_FALSE(world.decided(msgs::DecisionKind::kStale));
  EXPECT_EQ(world.last.at("tracker").level, graph::HealthLevel::kOk);
  EXPECT_EQ(world.last.at("planner").level, graph::HealthLevel::kOk);
  EXPECT_EQ(world.counter("planner", "stale_tracks"), 0);
}

/// With any fault of the odometry no view is used, and both components say so.
void expect_views_unused(World& world, const std::string& counter) {
  world.seconds = 6.0;
  run(world);
  EXPECT_GT(world.counter("tracker", counter), 0);
  EXPECT_EQ(world.last.at("tracker").level, graph::HealthLevel::kWarn);
  ASSERT_FALSE(world.tracks.empty());
  EXPECT_LE(world.newest_stamp_s(), kFault_s);
}

TEST(TrackerComponent, FusesTheSpeciesForThePlanner) {
  World world;
  world.spoil_images = [](furrow_msgs::msg::PlantInstances& message) {
    for (auto& weed : message.instances()) {
      weed.species().resize(2);
      weed.species()[0].species("foxtail");
      weed.species()[0].probability(0.4F);
      weed.species()[1].species("thistle");
      weed.species()[1].probability(0.5F);
      weed.leaves(4);
    }
    return true;
  };
  run(world);
  ASSERT_FALSE(world.tracks.back().tracks().empty());
  const auto& track = world.tracks.back().tracks().back();
  ASSERT_EQ(track.species().size(), 2U);
  EXPECT_EQ(track.species()[0].species(), "thistle");
  EXPECT_GT(track.species()[0].probability(), 0.5F) << "several views are surer than one";
  EXPECT_EQ(track.leaves(), 4);
  std::size_t appraised = 0;
  for (const auto& decision : world.plans.back().decisions()) {
    if (decision.appraisal().valid() && decision.appraisal().species() == "thistle") ++appraised;
  }
  EXPECT_GT(appraised, 0U);
}

TEST(TrackerComponent, ImagesWithoutOdometryAreDropped) {
  World world;
  world.spoil = [](Odometry&) { return false; };
  expect_views_unused(world, "images_without_pose");
  EXPECT_GT(world.counter("planner", "no_pose"), 0) << "nor can the planner plan";
}

TEST(TrackerComponent, NonFinitePosesAreCounted) {
  World world;
  world.spoil = [](Odometry& odometry) {
    odometry.pose().pose().position().x(kNan);
    return true;
  };
  expect_views_unused(world, "bad_odometry");
}

TEST(TrackerComponent, OdometryThatGoesBackInTimeIsCounted) {
  World world;
  world.spoil = [](Odometry& odometry) {
    const Time stamp = graph::from_msg(odometry.header().stamp());
    odometry.header().stamp(graph::to_msg(stamp - Duration::seconds(3.0)));
    return true;
  };
  expect_views_unused(world, "bad_odometry");
}

TEST(TrackerComponent, InvalidCovarianceMakesTheTargetsStale) {
  World world;
  world.spoil = [](Odometry& odometry) {
    odometry.pose().covariance()[0] = -1.0;
    return true;
  };
  expect_views_unused(world, "bad_views");
  EXPECT_GT(world.counter("planner", "stale_tracks"), 0);
  EXPECT_EQ(world.last.at("planner").level, graph::HealthLevel::kWarn);
  EXPECT_TRUE(world.decided(msgs::DecisionKind::kStale));
  for (const auto& route : world.plans.back().routes()) EXPECT_TRUE(route.stops().empty());
}

TEST(TrackerComponent, LateOdometryDelaysTracksWithoutLoss) {
  World world;
  std::vector<Odometry> late;
  world.spoil = [&late](Odometry& odometry) {
    late.push_back(odometry);
    constexpr std::size_t kSteps = 20;
    if (late.size() <= kSteps) return false;
    odometry = late[late.size() - 1 - kSteps];
    return true;
  };
  run(world);
  EXPECT_EQ(world.counter("tracker", "images_without_pose"), 0);
  EXPECT_GT(world.newest_stamp_s(), world.seconds - 0.7);
}

TEST(TrackerComponent, EmptyImagesAreCountedAndDegradeTheHealth) {
  World world;
  world.seconds = 9.0;
  world.spoil_images = [](furrow_msgs::msg::PlantInstances& message) {
    message.instances().clear();
    return true;
  };
  run(world);
  EXPECT_GE(world.counter("tracker", "empty_views"), 30);
  EXPECT_EQ(world.last.at("tracker").level, graph::HealthLevel::kWarn);
}

TEST(TrackerComponent, WithoutImagesThePlannerWarnsOfStaleTargets) {
  World world;
  world.spoil_images = [](furrow_msgs::msg::PlantInstances&) { return false; };
  run(world);
  EXPECT_EQ(world.counter("planner", "tracks_missing"), 1);
  EXPECT_EQ(world.last.at("planner").level, graph::HealthLevel::kWarn);
}

}  // namespace
}  // namespace furrow::components
