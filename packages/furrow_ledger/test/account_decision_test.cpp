// The decision that the ledger names for a plant.

#include "account_fixture.hpp"

namespace furrow::ledger::test {
namespace {

Spray spray_at(double t, double x, double y, std::vector<std::int64_t> tracks) {
  Spray s = spray(x, y, std::move(tracks));
  s.time = Time::from_seconds(t);
  return s;
}

TEST(Account, DecisionOfATreatedWeedIsTheOneBeforeItsSpray) {
  RunRecord record;
  record.tracks = {track(7, 1.0, 0.1)};
  record.sprays = {spray_at(5.0, 1.0, 0.1, {7})};
  // Passed, and then skipped by the driver where it was planned again: both after the spray.
  record.decisions = {treat(7, 3.0), leave(7, Reason::kUnreachable, 6.0),
                      leave(7, Reason::kStale, 9.0)};
  const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.1)}), record);
  EXPECT_EQ(row.outcome, Outcome::kAccurate);
  EXPECT_EQ(row.action, Action::kTreat);
  EXPECT_EQ(row.reason, Reason::kNone);
}

TEST(Account, DecisionBehindASprayIsTheLastToTreatEvenIfWithdrawnBeforeItLands) {
  RunRecord record;
  record.tracks = {track(7, 1.0, 0.1)};
  record.sprays = {spray_at(5.0, 1.0, 0.1, {7})};
  record.decisions = {leave(7, Reason::kUnreachable, 1.0), treat(7, 3.0),
                      leave(7, Reason::kUnreachable, 4.99)};
  const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.1)}), record);
  EXPECT_EQ(row.action, Action::kTreat);
}

TEST(Account, WeedThatASprayForAnotherTookKeepsItsOwnDecision) {
  RunRecord record;
  record.tracks = {track(7, 1.0, 0.1), track(8, 1.3, 0.1)};
  record.sprays = {spray_at(5.0, 1.005, 0.1, {8})};
  record.decisions = {leave(7, Reason::kUnreachable, 2.0), treat(8, 2.0), treat(7, 8.0)};
  const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.1)}), record);
  EXPECT_EQ(row.outcome, Outcome::kAccurate);
  EXPECT_EQ(row.action, Action::kLeave);
}

TEST(Account, MissedWeedKeepsItsLastDecision) {
  RunRecord record;
  record.tracks = {track(7, 1.0, 0.1)};
  record.decisions = {treat(7, 3.0), leave(7, Reason::kUnreachable, 6.0)};
  const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.1)}), record);
  EXPECT_EQ(row.outcome, Outcome::kMissed);
  EXPECT_EQ(row.action, Action::kLeave);
  EXPECT_EQ(row.reason, Reason::kUnreachable);
}

}  // namespace
}  // namespace furrow::ledger::test
