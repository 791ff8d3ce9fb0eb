// The record of a run as the scorer collects it, in simulated time.

#include <gtest/gtest.h>

#include <functional>
#include <optional>
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
using furrow_msgs::msg::RunRecord;
using msgs::DecisionKind;

/// What the scorer is given, and its record.
struct Day {
  geometry::Pose2 start;
  double step_m = 0.0;  ///< along x, each 10 ms
  bool true_field = false;
  bool true_odometry = false;
  std::vector<furrow_msgs::msg::Track> tracks;
  std::vector<std::uint8_t> decisions;  ///< about track 1, one each 10 ms
  std::vector<std::uint8_t> events;     ///< of axis_1, one each 10 ms
  std::optional<RunRecord> record;
};

class Stage final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.input<topics::RunRecord>()
        .output<topics::TrueField>()
        .output<topics::TrueOdometry>()
        .output<topics::RobotOdometry>()
        .output<topics::Tracks>()
        .output<topics::Plan>()
        .output<topics::AxisEvent>()
        .output<topics::AxisState>()
        .output<topics::RunStatus>();
  }

  Stage(graph::Context& context, Day& day)
      : day_(day),
        field_out_(context.output<topics::TrueField>()),
        truth_out_(context.output<topics::TrueOdometry>()),
        odometry_out_(context.output<topics::RobotOdometry>()),
        tracks_out_(context.output<topics::Tracks>()),
        plan_out_(context.output<topics::Plan>()),
        event_out_(context.output<topics::AxisEvent>()),
        status_out_(context.output<topics::RunStatus>()) {
    (void)context.output<topics::AxisState>();
    context.every(Duration::milliseconds(10), [this](Time now) { step(now); });
    context.input<topics::RunRecord>([this, &context](const auto& record) {
      day_.record = *record;
      context.request_stop("finished");
    });
  }

 private:
  void step(Time now) {
    const std::size_t i = step_++;
    geometry::Pose2 pose = day_.start;
    pose.x_m += day_.step_m * static_cast<double>(i);
    const auto odometry = to_msg(BaseOdometry{now, pose, 0.5, 0.0}, kFieldFrame);
    odometry_out_.publish(odometry);
    if (day_.true_field && i == 0) field_out_.publish(furrow_msgs::msg::TrueField());
    if (day_.true_odometry) truth_out_.publish(odometry);
    if (i == 0) {
      furrow_msgs::msg::Tracks tracks;
      tracks.tracks(day_.tracks);
      tracks_out_.publish(std::move(tracks));
    }
    if (i < day_.decisions.size()) {
      furrow_msgs::msg::Plan plan;
      auto& decision = plan.decisions().emplace_back();
      decision.stamp(graph::to_msg(now));
      decision.track_id(1);
      decision.decision().value(day_.decisions[i]);
      plan_out_.publish(std::move(plan));
    }
    if (i < day_.events.size()) {
      furrow_msgs::msg::AxisEvent event;
      event.axis("axis_1");
      event.event().value(day_.events[i]);
      event_out_.publish(std::move(event));
    }
    furrow_msgs::msg::RunStatus status;
    status.header(header(now, ""));
    status.finished(i == 20);
    status_out_.publish(std::move(status));
  }

  Day& day_;
  graph::Output<topics::TrueField> field_out_;
  graph::Output<topics::TrueOdometry> truth_out_;
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::Tracks> tracks_out_;
  graph::Output<topics::Plan> plan_out_;
  graph::Output<topics::AxisEvent> event_out_;
  graph::Output<topics::RunStatus> status_out_;
  std::size_t step_ = 0;
};

struct Ended {
  std::string reason;
  graph::Health health;  ///< of the scorer
};

Ended run(Day& day) {
  graph::Registry registry;
  registry.load_library(FURROW_SCORER_LIBRARY);
  registry.add(feeder_class<Stage>(day));
  graph::GraphSpec spec;
  spec.components = {{.name = "scorer",
                      .group = "scorer",
                      .class_name = "scorer",
                      .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  const std::string reason = runtime.run().reason;
  return {reason, runtime.status()[0].health};
}

std::uint8_t number(DecisionKind kind) {
  return static_cast<std::uint8_t>(kind);
}

TEST(ScorerComponent, KeepsEveryChangeOfADecisionAndTheLast) {
  Day day;
  const std::uint8_t treat = number(DecisionKind::kTreat);
  const std::uint8_t behind = number(DecisionKind::kUnreachable);
  day.decisions = {behind, treat, treat, treat, treat, behind, behind, behind};
  EXPECT_EQ(run(day).reason, "finished");
  ASSERT_TRUE(day.record.has_value());
  std::vector<std::pair<std::int64_t, std::uint8_t>> kept;
  for (const auto& decision : day.record->decisions()) {
    kept.emplace_back(graph::from_msg(decision.stamp()).count_ns() / 1'000'000,
                      decision.decision().value());
  }
  // The first and the last of equal ones in a row.
  const std::vector<std::pair<std::int64_t, std::uint8_t>> expected = {
      {10, behind}, {20, treat}, {50, treat}, {60, behind}, {80, behind}};
  EXPECT_EQ(kept, expected);
}

TEST(ScorerComponent, UnknownValuesAreCountedAndNotRecorded) {
  Day day;
  day.decisions = {number(DecisionKind::kTreat), 0, 200};
  day.events = {static_cast<std::uint8_t>(msgs::AxisEventKind::kSprayed), 0, 99};
  const Ended ended = run(day);
  ASSERT_TRUE(day.record.has_value());
  EXPECT_EQ(day.record->decisions().size(), 1u);
  EXPECT_EQ(day.record->events().size(), 1u);
  EXPECT_EQ(ended.health.counters.at("unknown_values"), 4);
}

TEST(ScorerComponent, GroundTruthNeedsFieldAndOdometry) {
  for (const bool field : {false, true}) {
    for (const bool odometry : {false, true}) {
      Day day;
      day.true_field = field;
      day.true_odometry = odometry;
      (void)run(day);
      ASSERT_TRUE(day.record.has_value());
      EXPECT_EQ(day.record->ground_truth(), field && odometry);
    }
  }
}

TEST(ScorerComponent, TrackWithoutAUsablePositionIsCountedAndLeftOut) {
  Day day;
  day.tracks.resize(3);
  for (std::size_t i = 0; i < 3; ++i) day.tracks[i].id(static_cast<std::int64_t>(i));
  day.tracks[1].position().x(std::numeric_limits<double>::quiet_NaN());
  day.tracks[2].position().y(5.6e6);
  const Ended ended = run(day);
  ASSERT_TRUE(day.record.has_value());
  ASSERT_EQ(day.record->tracks().size(), 1u);
  EXPECT_EQ(day.record->tracks()[0].id(), 0);
  EXPECT_EQ(ended.health.counters.at("bad_tracks"), 2);
}

TEST(ScorerComponent, RefusesOdometryInAMapFrameAtTheStart) {
  Day day;
  day.start = {300'000.0, 5'600'000.0, 0.0};
  const std::string reason = run(day).reason;
  EXPECT_FALSE(day.record.has_value());
  EXPECT_EQ(reason,
            "scorer: localization/odometry starts at x 300000.0 m, y 5600000.0 m, more than 10 km "
            "from the origin of the field frame; is it a map frame, such as UTM? Publish it "
            "relative to a place in the field");
}

TEST(ScorerComponent, TakesTheDistanceFromThePosesWhereNothingElseTellsIt) {
  Day day{.start = {}, .step_m = 0.005};
  EXPECT_EQ(run(day).reason, "finished");
  ASSERT_TRUE(day.record);
  EXPECT_NEAR(day.record->distance_m(), 20 * 0.005, 0.006);  // the last pose may be the next one
}

}  // namespace
}  // namespace furrow::components
