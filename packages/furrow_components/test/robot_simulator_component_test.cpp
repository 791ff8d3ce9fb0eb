// The simulated robot and speed requests, in simulated time.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

constexpr double kOwn_mps = 0.5;

/// The requested speed over time, and the motion of the robot.
struct World {
  double seconds = 6.0;
  std::function<std::optional<double>(double)> ask = [](double) { return std::nullopt; };
  Duration stamp_offset;  ///< from the time of publication to the stamp of a request
  std::vector<BaseOdometry> drive;

  [[nodiscard]] double speed_at(double t_s) const {
    for (const BaseOdometry& base : drive) {
      if (base.stamp >= Time::from_seconds(t_s)) return base.speed_mps;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};

class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, World& world)
      : world_(world), out_(context.output<topics::SpeedRequest>()) {
    context.every(Duration::milliseconds(20), [this, &context](Time now) {
      if (const auto speed_mps = world_.ask(now.to_seconds())) {
        geometry_msgs::msg::TwistStamped message;
        message.header(header(now + world_.stamp_offset, kBaseFrame));
        message.twist().linear().x(*speed_mps);
        out_.publish(std::move(message));
      }
      if (now.to_seconds() >= world_.seconds) context.request_stop("finished");
    });
    context.input<topics::TrueOdometry>(
        [this](const auto& truth) { world_.drive.push_back(from_msg(*truth)); });
  }

  static void describe(graph::Description& d) {
    d.input<topics::TrueOdometry>().output<topics::SpeedRequest>();
  }

 private:
  World& world_;
  graph::Output<topics::SpeedRequest> out_;
};

void run(World& world, bool follow) {
  graph::Registry registry;
  registry.load_library(FURROW_ROBOT_LIBRARY);
  registry.add(feeder_class<Feeder>(world));
  graph::GraphSpec spec;
  spec.components = {{.name = "robot",
                      .group = "robot",
                      .class_name = "robot_simulator",
                      .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}},
                                     {"speed_mps", kOwn_mps, {}},
                                     {"limit_acceleration_mps2", 0.5, {}},
                                     {"speed_request_timeout_s", 0.4, {}},
                                     {"speed_noise_mps", 0.01, {}},
                                     {"follow_speed_requests", follow, {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  if (follow) spec.components[0].parameters[4].value = 0.0;
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
}

TEST(RobotSimulator, FollowsALowerSpeedRequest) {
  World world;
  world.ask = [](double t_s) { return t_s < 1.0 ? kOwn_mps : 0.3; };
  run(world, true);
  EXPECT_NEAR(world.speed_at(0.9), kOwn_mps, 1e-9);
  EXPECT_NEAR(world.speed_at(1.2), 0.4, 0.02) << "0.5 m/s2";
  EXPECT_NEAR(world.speed_at(2.0), 0.3, 1e-9);
}

TEST(RobotSimulator, ReturnsToItsOwnSpeedWithoutRequests) {
  World world;
  world.ask = [](double t_s) { return t_s < 2.0 ? std::optional(0.2) : std::nullopt; };
  run(world, true);
  EXPECT_NEAR(world.speed_at(2.35), 0.2, 1e-9) << "within the timeout the last request holds";
  EXPECT_NEAR(world.speed_at(2.75), 0.35, 0.04) << "then gently";
  EXPECT_NEAR(world.speed_at(3.5), kOwn_mps, 1e-9);
}

TEST(RobotSimulator, FollowsRequestsThatResume) {
  World world;
  world.ask = [](double t_s) { return t_s < 1.0 || t_s > 3.0 ? std::optional(0.2) : std::nullopt; };
  run(world, true);
  EXPECT_NEAR(world.speed_at(2.9), kOwn_mps, 1e-9);
  EXPECT_NEAR(world.speed_at(4.5), 0.2, 1e-9);
}

TEST(RobotSimulator, IgnoresRequestsThatAreStaleOrOfAnotherClock) {
  for (const double offset_s : {-0.5, 0.5}) {
    World world;
    world.ask = [](double) { return 0.2; };
    world.stamp_offset = Duration::seconds(offset_s);
    run(world, true);
    EXPECT_NEAR(world.speed_at(4.0), kOwn_mps, 1e-9) << offset_s;
  }
}

TEST(RobotSimulator, IgnoresRequestsAboveItsOwnSpeedOrInvalid) {
  for (const double asked_mps : {0.9, -0.2, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity()}) {
    World world;
    world.ask = [&](double) { return asked_mps; };
    run(world, true);
    for (const BaseOdometry& base : world.drive) EXPECT_NEAR(base.speed_mps, kOwn_mps, 1e-9);
  }
}

TEST(RobotSimulator, IgnoresRequestsWhereFollowingIsOff) {
  World asked;
  asked.ask = [](double) { return 0.2; };
  World alone;
  run(asked, false);
  run(alone, false);
  ASSERT_EQ(asked.drive.size(), alone.drive.size());
  for (std::size_t i = 0; i < alone.drive.size(); ++i) {
    EXPECT_EQ(asked.drive[i].X_FB.x_m, alone.drive[i].X_FB.x_m);
    EXPECT_EQ(asked.drive[i].X_FB.y_m, alone.drive[i].X_FB.y_m);
  }
}

}  // namespace
}  // namespace furrow::components
