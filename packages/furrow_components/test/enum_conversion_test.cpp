// Every value of an algorithm's enumeration has its own constant in the message.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "../src/axis_conversion.hpp"
#include "../src/plan_conversion.hpp"

namespace furrow::components {
namespace {

/// Where the algorithm and the message use the same words, the conversion keeps them.
template <class Algorithm, class Convert>
void expect_same_words(std::initializer_list<Algorithm> values, Convert convert) {
  std::set<std::string> seen;
  for (const Algorithm value : values) {
    const std::string word(to_string(value));
    EXPECT_EQ(to_string(convert(value)), word);
    EXPECT_TRUE(seen.insert(word).second) << word;
  }
}

TEST(EnumConversion, DriveStatesKeepTheirWords) {
  using actuation::AxisState;
  expect_same_words({AxisState::kDisabled, AxisState::kHoming, AxisState::kReady,
                     AxisState::kMoving, AxisState::kFault, AxisState::kEmergencyStop},
                    drive_state);
}

TEST(EnumConversion, ModesKeepTheirWords) {
  using actuation::ControllerMode;
  expect_same_words({ControllerMode::kWaiting, ControllerMode::kRunning, ControllerMode::kSafe,
                     ControllerMode::kInactive},
                    axis_mode);
}

TEST(EnumConversion, SafetyCausesKeepTheirWordsInBothDirections) {
  using actuation::SafetyCause;
  const auto to_wire = [](SafetyCause cause) { return safety_cause(cause); };
  expect_same_words({SafetyCause::kNone}, to_wire);
  for (const actuation::SafetyRule& rule : actuation::safety_rules()) {
    expect_same_words({rule.cause}, to_wire);
    EXPECT_EQ(safety_cause(safety_cause(rule.cause)), rule.cause);
  }
  EXPECT_EQ(safety_cause(msgs::SafetyCause::kNone), SafetyCause::kNone);
}

TEST(EnumConversion, SkippedStopsAreReportedByTheirEffect) {
  using actuation::SkipReason;
  using msgs::AxisEventKind;
  EXPECT_EQ(skip_event(SkipReason::kNone), AxisEventKind::kSprayed);
  EXPECT_EQ(skip_event(SkipReason::kLate), AxisEventKind::kUnreachable);
  EXPECT_EQ(skip_event(SkipReason::kUnreachable), AxisEventKind::kUnreachable);
  EXPECT_EQ(skip_event(SkipReason::kStale), AxisEventKind::kStale);
  EXPECT_EQ(skip_event(SkipReason::kProtectedCrop), AxisEventKind::kProtectedCrop);
  EXPECT_EQ(skip_event(SkipReason::kFault), AxisEventKind::kFault);
  EXPECT_EQ(skip_event(SkipReason::kStanding), AxisEventKind::kFault);
  EXPECT_EQ(skip_event(SkipReason::kInactive), AxisEventKind::kInactive);
}

TEST(EnumConversion, DecisionsAreReportedByTheirEffect) {
  using msgs::DecisionKind;
  using planning::Decision;
  expect_same_words({Decision::kTreat, Decision::kUnreachable, Decision::kLowPriority,
                     Decision::kProtectedCrop, Decision::kOutside, Decision::kAxisFault},
                    decision_kind);
  EXPECT_EQ(decision_kind(Decision::kBehind), DecisionKind::kUnreachable);
  EXPECT_EQ(decision_kind(Decision::kInvalid), DecisionKind::kStale);
  EXPECT_EQ(decision_kind(Decision::kDuplicate), DecisionKind::kStale);
}

}  // namespace
}  // namespace furrow::components
