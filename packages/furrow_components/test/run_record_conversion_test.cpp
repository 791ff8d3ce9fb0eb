#include "furrow_components/run_record_conversion.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {
namespace {

using ledger::Action;
using ledger::Reason;
using msgs::AxisEventKind;
using msgs::DecisionKind;

std::vector<geometry::AxisModel> two_axes() {
  std::vector<geometry::AxisModel> axes(2);
  axes[0].name = "axis_1";
  axes[1].name = "axis_2";
  axes[1].nozzle.footprint_radius_m = 0.03;
  return axes;
}
const std::vector<geometry::AxisModel> kAxes = two_axes();

furrow_msgs::msg::RunRecord record_of(DecisionKind decision) {
  furrow_msgs::msg::RunRecord record;
  auto& entry = record.decisions().emplace_back();
  entry.stamp(graph::to_msg(Time::from_seconds(3.0)));
  entry.track_id(7);
  entry.decision(msgs::to_msg(decision));
  entry.axis("axis_2");
  return record;
}

TEST(RunRecordConversion, TreatNamesItsAxis) {
  const auto record = from_msg(record_of(DecisionKind::kTreat), kAxes);
  ASSERT_TRUE(record.ok());
  ASSERT_EQ(record->decisions.size(), 1u);
  EXPECT_EQ(record->decisions[0].action, Action::kTreat);
  EXPECT_EQ(record->decisions[0].axis, 1);
  EXPECT_EQ(record->decisions[0].track_id, 7);
  EXPECT_EQ(record->decisions[0].time, Time::from_seconds(3.0));
}

TEST(RunRecordConversion, EveryOtherDecisionLeavesForTheReasonOfTheSameName) {
  for (const auto kind :
       {DecisionKind::kUnreachable, DecisionKind::kLowPriority, DecisionKind::kProtectedCrop,
        DecisionKind::kOutside, DecisionKind::kStale, DecisionKind::kFault,
        DecisionKind::kUnconfirmed, DecisionKind::kUnsure}) {
    const auto record = from_msg(record_of(kind), kAxes);
    ASSERT_TRUE(record.ok());
    EXPECT_EQ(record->decisions[0].action, Action::kLeave);
    EXPECT_EQ(to_string(record->decisions[0].reason), to_string(kind));
    EXPECT_EQ(record->decisions[0].axis, -1);
  }
}

TEST(RunRecordConversion, SkippedStopLeavesItsTracks) {
  furrow_msgs::msg::RunRecord message;
  for (const auto kind : {AxisEventKind::kReset, AxisEventKind::kStale}) {
    auto& event = message.events().emplace_back();
    event.event(msgs::to_msg(kind));
    event.axis("axis_1");
    event.track_ids({4, 5});
  }
  const auto record = from_msg(message, kAxes);
  ASSERT_TRUE(record.ok());
  ASSERT_EQ(record->decisions.size(), 2u);
  EXPECT_EQ(record->decisions[1].track_id, 5);
  EXPECT_EQ(record->decisions[1].action, Action::kLeave);
  EXPECT_EQ(record->decisions[1].reason, Reason::kStale);
}

TEST(RunRecordConversion, AnOpenedValveOverridesWhatThePlannerSaysAfterwards) {
  auto message = record_of(DecisionKind::kUnreachable);
  auto& event = message.events().emplace_back();
  event.event(msgs::to_msg(AxisEventKind::kSprayed));
  event.axis("axis_2");
  event.track_ids({7});
  const auto record = from_msg(message, kAxes);
  ASSERT_TRUE(record.ok());
  ASSERT_EQ(record->decisions.size(), 2u);
  EXPECT_EQ(record->decisions[1].track_id, 7);
  EXPECT_EQ(record->decisions[1].action, Action::kTreat);
  EXPECT_EQ(record->decisions[1].reason, Reason::kNone);
  EXPECT_EQ(record->decisions[1].axis, 1);
}

TEST(RunRecordConversion, WithoutGroundTruthSpraysAreThoseOfTheDrivers) {
  furrow_msgs::msg::RunRecord message;
  for (const auto kind : {AxisEventKind::kSprayed, AxisEventKind::kDryRun}) {
    auto& event = message.events().emplace_back();
    event.event(msgs::to_msg(kind));
    event.axis("axis_2");
    event.track_ids({4});
    event.header().stamp(graph::to_msg(Time::from_seconds(5.0)));
    event.landing().x(1.25);
    event.aim().x(1.2);
  }
  message.sprays().emplace_back();  // without the true odometry, not all of them
  const auto record = from_msg(message, kAxes);
  ASSERT_TRUE(record.ok());
  ASSERT_EQ(record->sprays.size(), 1u);
  const ledger::Spray& spray = record->sprays[0];
  EXPECT_EQ(spray.axis, 1);
  EXPECT_EQ(spray.p_F_m.x(), 1.25);
  EXPECT_EQ(spray.aim_F_m.x(), 1.2);
  EXPECT_EQ(spray.radius_m, 0.03);
  EXPECT_EQ(spray.time, Time::from_seconds(5.0));
  EXPECT_EQ(spray.track_ids, std::vector<std::int64_t>{4});
}

TEST(RunRecordConversion, WithoutGroundTruthEveryConfirmedTrackHasALine) {
  furrow_msgs::msg::RunRecord message;
  for (const std::int64_t id : {1, 2, 3}) {
    auto& track = message.tracks().emplace_back();
    track.id(id);
    track.confirmed(id != 3);
    track.position().x(0.5 * static_cast<double>(id));
  }
  auto& event = message.events().emplace_back();
  event.event(msgs::to_msg(AxisEventKind::kSprayed));
  event.axis("axis_1");
  event.track_ids({2});
  event.landing().x(1.004);
  event.aim().x(1.0);
  const auto record = from_msg(message, kAxes);
  ASSERT_TRUE(record.ok());
  const auto ledger = account(message, *record, "day_3");
  ASSERT_TRUE(ledger.ok()) << ledger.error().message;
  EXPECT_FALSE(ledger->summary.against_truth);
  EXPECT_EQ(ledger->summary.field, "day_3");
  EXPECT_EQ(ledger->summary.sprays, 1);
  ASSERT_EQ(ledger->rows.size(), 2u);
  EXPECT_EQ(ledger->rows[0].outcome, ledger::Outcome::kMissed);
  EXPECT_EQ(ledger->rows[1].outcome, ledger::Outcome::kAccurate);
  EXPECT_EQ(ledger->rows[1].track_id, 2);
}

TEST(RunRecordConversion, WithGroundTruthPlantsAndSpraysAreItsOwn) {
  furrow_msgs::msg::RunRecord message;
  message.ground_truth(true);
  message.field().name("f");
  message.field().plants().emplace_back().id(9);
  auto& spray = message.sprays().emplace_back();
  spray.axis("axis_1");
  spray.radius_m(0.025);
  message.events().emplace_back().event(msgs::to_msg(AxisEventKind::kSprayed));
  message.tracks().emplace_back().confirmed(true);
  const auto record = from_msg(message, kAxes);
  ASSERT_TRUE(record.ok());
  ASSERT_EQ(record->sprays.size(), 1u);
  EXPECT_EQ(record->sprays[0].radius_m, 0.025);
  const auto ledger = account(message, *record, "");
  ASSERT_TRUE(ledger.ok());
  EXPECT_TRUE(ledger->summary.against_truth);
  ASSERT_EQ(ledger->rows.size(), 1u);
  EXPECT_EQ(ledger->rows[0].plant_id, 9);
}

TEST(RunRecordConversion, UnknownValueIsAnError) {
  auto decision = record_of(DecisionKind::kTreat);
  decision.decisions()[0].decision().value(99);
  const auto from_decision = from_msg(decision, kAxes);
  ASSERT_FALSE(from_decision.ok());
  EXPECT_EQ(from_decision.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(from_decision.error().message, "furrow_msgs/DecisionKind has no value 99");
  furrow_msgs::msg::RunRecord event;
  event.events().emplace_back();  // of no kind
  EXPECT_FALSE(from_msg(event, kAxes).ok());
}

}  // namespace
}  // namespace furrow::components
