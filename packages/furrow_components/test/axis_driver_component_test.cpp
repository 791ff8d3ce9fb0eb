// The axis driver as a component, in simulated time: it comes into service, sprays, enters the safe
// state and starts again.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using furrow_msgs::msg::AxisEvent;
using furrow_msgs::msg::AxisState;
using msgs::AxisEventKind;
using msgs::AxisMode;
using msgs::DriveState;
using msgs::SafetyCause;

constexpr double kSpeed_mps = 0.5;
constexpr double kSpacing_m = 0.2;

/// What goes on around the driver, and what it said.
struct World {
  double seconds = 6.0;
  std::function<bool(double)> planner_alive = [](double) { return true; };
  std::function<bool(double)> odometry_comes = [](double) { return true; };
  std::function<bool(double)> emergency_stop = [](double) { return false; };
  std::function<bool(double)> tracks_come = [](double) { return true; };
  std::function<bool(double)> tool_down = [](double) { return true; };
  std::function<bool(double)> bad_crop = [](double) { return false; };
  double seen_s_before = 0.0;  ///< how long before each plan its targets were seen
  std::vector<double> resets_s;
  msgs::SafetyCause reset_cause = msgs::SafetyCause::kNone;  ///< of the resets; kNone: all

  std::vector<AxisEvent> events;
  std::vector<AxisState> states;
  std::vector<diagnostic_msgs::msg::DiagnosticStatus> diagnostics;
  graph::Health health;

  [[nodiscard]] std::vector<AxisEvent> events_of(AxisEventKind kind) const {
    std::vector<AxisEvent> list;
    std::ranges::copy_if(events, std::back_inserter(list),
                         [&](const AxisEvent& event) { return event.event() == kind; });
    return list;
  }
  [[nodiscard]] int sprays_between(double from_s, double to_s) const {
    int count = 0;
    for (const AxisEvent& event : events_of(AxisEventKind::kSprayed)) {
      const double at_s = graph::from_msg(event.opened()).to_seconds();
      count += from_s <= at_s && at_s < to_s ? 1 : 0;
    }
    return count;
  }
};

class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, World& world)
      : world_(world),
        plan_out_(context.output<topics::Plan>()),
        heartbeat_out_(context.output<topics::PlannerHeartbeat>()),
        odometry_out_(context.output<topics::RobotOdometry>()),
        tracks_out_(context.output<topics::Tracks>()),
        stop_out_(context.output<topics::EmergencyStop>()),
        reset_out_(context.output<topics::ToolReset>()),
        enable_out_(context.output<topics::ToolEnable>()) {
    context.every(Duration::milliseconds(10), [this, &context](Time now) {
      step(now);
      if (now.to_seconds() >= world_.seconds) context.request_stop("finished");
    });
    context.every(Duration::milliseconds(20), [this](Time now) {
      if (world_.planner_alive(now.to_seconds())) {
        heartbeat_out_.publish(furrow_msgs::msg::Heartbeat());
      }
    });
    context.every(Duration::milliseconds(200), [this](Time now) { plan(now); });
    context.input<topics::AxisEvent>(
        [this](const auto& event) { world_.events.push_back(*event); });
    context.input<topics::AxisState>(
        [this](const auto& state) { world_.states.push_back(*state); });
    context.input<topics::Diagnostics>([this](const auto& array) {
      for (const auto& status : array->status()) {
        // The graph itself tells of every component besides.
        if (status.name().starts_with("driver:")) world_.diagnostics.push_back(status);
      }
    });
  }

  static void describe(graph::Description& d) {
    d.input<topics::AxisEvent>()
        .input<topics::AxisState>()
        .input<topics::Diagnostics>()
        .output<topics::Plan>()
        .output<topics::PlannerHeartbeat>()
        .output<topics::RobotOdometry>()
        .output<topics::Tracks>()
        .output<topics::EmergencyStop>()
        .output<topics::ToolReset>()
        .output<topics::ToolEnable>();
  }

 private:
  void step(Time now) {
    const double t_s = now.to_seconds();
    if (world_.odometry_comes(t_s)) {
      odometry_out_.publish(
          to_msg(BaseOdometry{now, {kSpeed_mps * t_s, 0.0, 0.0}, kSpeed_mps, 0.0}, kFieldFrame));
    }
    if (world_.emergency_stop(t_s) != pressed_) {
      pressed_ = !pressed_;
      furrow_msgs::msg::EmergencyStop message;
      message.active(pressed_);
      stop_out_.publish(std::move(message));
    }
    for (const double reset_s : world_.resets_s) {
      if (std::abs(t_s - reset_s) >= 0.004) continue;
      furrow_msgs::msg::ToolReset reset;
      reset.cause(msgs::to_msg(world_.reset_cause));
      reset_out_.publish(std::move(reset));
    }
    if (world_.tool_down(t_s) == down_) return;
    down_ = !down_;
    furrow_msgs::msg::ToolEnable enable;
    enable.active(down_);
    enable_out_.publish(std::move(enable));
  }

  void plan(Time now) {
    if (!world_.planner_alive(now.to_seconds())) return;
    furrow_msgs::msg::Plan plan;
    plan.header(header(now, kFieldFrame));
    auto& route = plan.routes().emplace_back();
    route.axis("axis_1");
    const auto first = static_cast<std::int64_t>(kSpeed_mps * now.to_seconds() / kSpacing_m);
    for (std::int64_t i = first + 1; i < first + 12; ++i) {
      auto& stop = route.stops().emplace_back();
      stop.id(i);
      const double y_m = i % 2 == 0 ? 0.1 : -0.1;
      stop.aim(to_point(Eigen::Vector2d(kSpacing_m * static_cast<double>(i), y_m)));
      stop.track_ids({i});
      stop.observed(graph::to_msg(now - Duration::seconds(world_.seen_s_before)));
    }
    plan_out_.publish(std::move(plan));
    if (!world_.tracks_come(now.to_seconds())) return;
    furrow_msgs::msg::Tracks tracks;
    tracks.header(header(now, kFieldFrame));
    if (world_.bad_crop(now.to_seconds())) {
      auto& track = tracks.tracks().emplace_back();
      track.confirmed(true);
      track.crop_probability(0.9);
      track.position().x(std::numeric_limits<double>::quiet_NaN());
    }
    tracks_out_.publish(std::move(tracks));
  }

  World& world_;
  graph::Output<topics::Plan> plan_out_;
  graph::Output<topics::PlannerHeartbeat> heartbeat_out_;
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::Tracks> tracks_out_;
  graph::Output<topics::EmergencyStop> stop_out_;
  graph::Output<topics::ToolReset> reset_out_;
  graph::Output<topics::ToolEnable> enable_out_;
  bool pressed_ = false;
  bool down_ = true;
};

void run(World& world, const std::map<std::string, ParameterValue>& parameters = {}) {
  graph::Registry registry;
  registry.load_library(FURROW_AXIS_DRIVER_LIBRARY);
  registry.add(feeder_class<Feeder>(world));
  graph::GraphSpec spec;
  spec.components = {{.name = "driver",
                      .group = "driver",
                      .class_name = "axis_driver",
                      .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}},
                                     {"axis", std::string("axis_1"), {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  for (const auto& [name, value] : parameters) {
    spec.components[0].parameters.push_back({name, value, {}});
  }
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
  world.health = runtime.status()[0].health;
}

TEST(AxisDriverComponent, SpraysItsPlanAndCountsWhatItUses) {
  World world;
  run(world);
  // 2.5 sprays a second, from when the first plan is there.
  const int sprays = world.sprays_between(0.0, 6.0);
  EXPECT_GE(sprays, 13);
  const AxisState& last = world.states.back();
  EXPECT_TRUE(last.mode() == AxisMode::kRunning);
  EXPECT_TRUE(last.cause() == SafetyCause::kNone);
  EXPECT_GE(static_cast<int>(last.openings()), sprays);
  EXPECT_NEAR(last.open_s(), 0.010 * sprays, 0.012);  // of 10 ms each
  EXPECT_NEAR(last.volume_ml(), 5.0 * last.open_s(), 1e-9);
  for (const AxisEvent& event : world.events_of(AxisEventKind::kSprayed)) {
    EXPECT_NEAR(event.landing().x(), event.aim().x(), 0.002);
    EXPECT_NEAR(event.landing().y(), event.aim().y(), 0.002);
    EXPECT_NEAR(event.volume_ml(), 0.05, 0.011);
  }
  EXPECT_EQ(world.health.level, graph::HealthLevel::kOk);
}

TEST(AxisDriverComponent, ADriveWithoutPowerIsEnabledAndHomedFirst) {
  World world;
  run(world, {{"simulated_start_ready", false}, {"simulated_start_position_m", 0.5}});
  EXPECT_TRUE(world.states.front().state() == DriveState::kHoming);
  EXPECT_TRUE(world.states.back().mode() == AxisMode::kRunning);
  EXPECT_GT(world.sprays_between(3.0, 6.0), 5);
}

TEST(AxisDriverComponent, ADryRunMovesAndOpensNothing) {
  World world;
  run(world, {{"dry_run", true}});
  EXPECT_TRUE(world.events_of(AxisEventKind::kSprayed).empty());
  EXPECT_GT(world.events_of(AxisEventKind::kDryRun).size(), 10u);
  EXPECT_EQ(world.states.back().openings(), 0u);
  EXPECT_GT(world.states.back().travel_m(), 1.0);
}

TEST(AxisDriverComponent, AnEmergencyStopIsLatchedUntilItIsReset) {
  World world;
  world.emergency_stop = [](double t_s) { return t_s >= 2.0 && t_s < 3.0; };
  world.resets_s = {2.5, 4.0};  // the first while it is still pressed
  run(world);
  const auto safe = world.events_of(AxisEventKind::kSafeState);
  ASSERT_FALSE(safe.empty());
  EXPECT_TRUE(safe[0].cause() == SafetyCause::kEmergencyStop);
  EXPECT_NEAR(graph::from_msg(safe[0].closed()).to_seconds(), 2.0, 0.004);
  EXPECT_GT(world.sprays_between(0.0, 2.0), 2);
  EXPECT_EQ(world.sprays_between(2.005, 4.0), 0);
  EXPECT_GT(world.sprays_between(4.0, 6.0), 3);
  // What came due meanwhile is in the ledger as a fault.
  EXPECT_GE(world.events_of(AxisEventKind::kFault).size(), 3u);
  EXPECT_EQ(world.health.level, graph::HealthLevel::kOk);
}

TEST(AxisDriverComponent, ASilentPlannerLatchesTheSafeState) {
  World world;
  world.planner_alive = [](double t_s) { return t_s < 2.0 || t_s > 3.0; };
  run(world);
  const auto safe = world.events_of(AxisEventKind::kSafeState);
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_TRUE(safe[0].cause() == SafetyCause::kPeerLost);
  EXPECT_NEAR(graph::from_msg(safe[0].closed()).to_seconds(), 1.98 + 0.07, 0.004);
  EXPECT_EQ(world.sprays_between(2.1, 6.0), 0);
  EXPECT_TRUE(world.states.back().cause() == SafetyCause::kPeerLost);
  EXPECT_EQ(world.health.level, graph::HealthLevel::kError);
  EXPECT_TRUE(world.health.message.starts_with("peer_lost at 2.0")) << world.health.message;
  ASSERT_GE(world.diagnostics.size(), 5u);  // one a second
  EXPECT_EQ(world.diagnostics[0].level(), 0);
  EXPECT_EQ(world.diagnostics[0].message(), "running");
  EXPECT_EQ(world.diagnostics.back().level(), 2);
  EXPECT_EQ(world.diagnostics.back().name(), "driver: axis_1");
  EXPECT_TRUE(world.diagnostics.back().message().starts_with("peer_lost at 2.05"));
}

TEST(AxisDriverComponent, StoppedOdometryLatchesTheSafeStateUntilReset) {
  World world;
  world.odometry_comes = [](double t_s) { return t_s < 2.0 || t_s > 3.0; };
  world.resets_s = {4.0};
  run(world);
  const auto safe = world.events_of(AxisEventKind::kSafeState);
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_TRUE(safe[0].cause() == SafetyCause::kOdometryStale);
  EXPECT_GT(world.sprays_between(4.0, 6.0), 3);
}

TEST(AxisDriverComponent, AValveThatCannotBeReachedIsAFault) {
  World world;
  // No server listens at port 9 of the loopback.
  run(world, {{"valve", std::string("modbus_coils")}, {"coil_port", std::int64_t{9}}});
  ASSERT_FALSE(world.events_of(AxisEventKind::kSafeState).empty());
  EXPECT_TRUE(world.events_of(AxisEventKind::kSafeState)[0].cause() == SafetyCause::kValveFault);
  EXPECT_TRUE(world.events_of(AxisEventKind::kSprayed).empty());
}

TEST(AxisDriverComponent, ACropThatIsNotFiniteIsACauseForTheSafeState) {
  World world;
  world.bad_crop = [](double t_s) { return t_s > 2.0 && t_s < 2.5; };
  run(world);
  const auto safe = world.events_of(AxisEventKind::kSafeState);
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_TRUE(safe[0].cause() == msgs::SafetyCause::kProtectionInvalid);
  EXPECT_EQ(world.sprays_between(2.3, 6.0), 0);
}

TEST(AxisDriverComponent, WithoutTracksCropsAreNotProtectedAndNothingIsSprayed) {
  World world;
  world.tracks_come = [](double t_s) { return t_s < 2.0; };  // plans go on
  run(world);
  const auto safe = world.events_of(AxisEventKind::kSafeState);
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_TRUE(safe[0].cause() == msgs::SafetyCause::kTracksStale);
  EXPECT_NEAR(graph::from_msg(safe[0].closed()).to_seconds(), 1.8 + 2.0, 0.004);
  EXPECT_EQ(world.sprays_between(3.81, 6.0), 0);
}

TEST(AxisDriverComponent, TargetsThatWereNotSeenForTooLongAreNotSprayed) {
  World world;
  world.seen_s_before = 3.0;
  run(world, {{"max_target_age_s", 2.5}});
  EXPECT_EQ(world.sprays_between(0.0, 6.0), 0);
  EXPECT_GT(world.events_of(AxisEventKind::kStale).size(), 5u);
}

TEST(AxisDriverComponent, AResetOfAnotherCauseLeavesALatchedOneAlone) {
  World world;
  world.emergency_stop = [](double t_s) { return t_s >= 2.0 && t_s < 3.0; };
  world.resets_s = {4.0};
  world.reset_cause = msgs::SafetyCause::kPeerLost;
  run(world);
  EXPECT_TRUE(world.states.back().mode() == AxisMode::kSafe);
  EXPECT_TRUE(world.states.back().cause() == msgs::SafetyCause::kEmergencyStop);
  ASSERT_EQ(world.states.back().latched().size(), 1u);
  EXPECT_TRUE(world.events_of(AxisEventKind::kReset).empty());
}

TEST(AxisDriverComponent, AResetWhileTheCauseHoldsIsRefused) {
  World world;
  world.emergency_stop = [](double t_s) { return t_s >= 2.0; };
  world.resets_s = {4.0};
  run(world);
  EXPECT_EQ(world.events_of(AxisEventKind::kResetRefused).size(), 1u);
  EXPECT_TRUE(world.states.back().mode() == AxisMode::kSafe);
}

TEST(AxisDriverComponent, LatchesSurviveARestartOfTheProcess) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("furrow_axis_latches_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  const std::map<std::string, ParameterValue> kept = {{"latch_folder", folder.string()}};
  World first;
  first.emergency_stop = [](double t_s) { return t_s >= 2.0 && t_s < 3.0; };
  run(first, kept);
  World second;
  second.resets_s = {3.0};
  run(second, kept);
  EXPECT_EQ(second.sprays_between(0.0, 3.0), 0);
  EXPECT_TRUE(second.states.front().cause() == msgs::SafetyCause::kEmergencyStop);
  EXPECT_GT(second.sprays_between(3.0, 6.0), 3);
  World third;
  run(third, kept);
  EXPECT_GT(third.sprays_between(0.0, 3.0), 3);
  std::filesystem::remove_all(folder);
}

TEST(AxisDriverComponent, ARaisedToolSpraysNothingAndTheStopsAreAccountedFor) {
  World world;
  world.tool_down = [](double t_s) { return t_s < 2.0 || t_s > 3.5; };
  run(world);
  EXPECT_EQ(world.sprays_between(2.02, 3.5), 0);
  EXPECT_GE(world.events_of(AxisEventKind::kInactive).size(), 3u);
  EXPECT_GT(world.sprays_between(3.5, 6.0), 4);
  EXPECT_TRUE(world.events_of(AxisEventKind::kSafeState).empty());
}

TEST(AxisDriverComponent, AnEmergencyStopInputThatIsNotThereIsAConfigurationError) {
  World world;
  EXPECT_THROW(run(world, {{"stop_input", std::string("gpio")},
                           {"stop_gpio_chip", std::string("no_such_chip")}}),
               ConfigError);
}

TEST(AxisDriverComponent, ADriveThatCannotBeReachedIsWaitedFor) {
  World world;
  run(world, {{"driver", std::string("cia402_modbus")}, {"drive_port", std::int64_t{9}}});
  EXPECT_TRUE(world.events_of(AxisEventKind::kSprayed).empty());
  EXPECT_TRUE(world.states.back().mode() == AxisMode::kWaiting);
  EXPECT_TRUE(world.states.back().state() == DriveState::kFault);
  EXPECT_EQ(world.health.level, graph::HealthLevel::kWarn);
  EXPECT_EQ(world.health.message, "drive: no connection to the drive");
}

}  // namespace
}  // namespace furrow::components
