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

const std::vector<std::string> kAxes = {"axis_1", "axis_2"};

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
  for (const auto kind : {DecisionKind::kUnreachable, DecisionKind::kLowPriority,
                          DecisionKind::kProtectedCrop, DecisionKind::kOutside,
                          DecisionKind::kStale, DecisionKind::kFault, DecisionKind::kUnconfirmed}) {
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
