#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "account_fixture.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/test_support/cpu_time.hpp"
#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger::test {
namespace {

TEST(Account, OutcomeFollowsTheDistanceToTheSprayCentre) {
  const auto model = field_of({plant(1, PlantKind::kWeed, 1.0, 0.0)});
  const auto outcome_at = [&](double offset_m) {
    RunRecord record;
    record.sprays = {spray(1.0 + offset_m, 0.0)};
    return only_row(model, record).outcome;
  };
  EXPECT_EQ(outcome_at(0.0), Outcome::kAccurate);
  EXPECT_EQ(outcome_at(0.0099), Outcome::kAccurate);
  EXPECT_EQ(outcome_at(0.0101), Outcome::kPartial);
  EXPECT_EQ(outcome_at(0.0249), Outcome::kPartial);
  EXPECT_EQ(outcome_at(0.0251), Outcome::kMissed);
}

TEST(Account, NearestSprayCounts) {
  RunRecord record;
  record.sprays = {spray(1.02, 0.0), spray(1.004, 0.0)};
  record.sprays[1].axis = 3;
  record.sprays[1].time = Time::from_seconds(4.0);
  const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.0)}), record);
  EXPECT_EQ(row.outcome, Outcome::kAccurate);
  EXPECT_EQ(row.axis, 3);
  EXPECT_EQ(row.sprayed, Time::from_seconds(4.0));
  EXPECT_NEAR(*row.spray_distance_m, 0.004, 1e-12);
}

TEST(Account, OneSprayMayTreatSeveralWeedsAndHitACrop) {
  RunRecord record;
  record.sprays = {spray(1.0, 0.0)};
  record.sprays[0].radius_m = 0.02;
  const auto ledger = account(
      field_of({plant(1, PlantKind::kWeed, 1.005, 0.0), plant(2, PlantKind::kWeed, 1.0, 0.022),
                plant(3, PlantKind::kCrop, 0.99, 0.0), plant(4, PlantKind::kCrop, 1.0, -0.021)}),
      record);
  ASSERT_TRUE(ledger.ok());
  EXPECT_EQ(ledger->summary.treated_accurate, 1);
  EXPECT_EQ(ledger->summary.treated_partial, 1);
  EXPECT_EQ(ledger->summary.crops_hit, 1);  // the other stands outside the footprint of 20 mm
  EXPECT_EQ(ledger->summary.crops_total, 2);
  EXPECT_EQ(ledger->summary.sprays_without_weed, 0);
}

TEST(Account, EachCauseHasItsCase) {
  struct Case {
    Reason expected;
    RunRecord record;
  };
  const auto with = [](std::vector<TrackView> tracks, std::vector<Decision> decisions,
                       std::vector<Spray> sprays = {}) {
    RunRecord record;
    record.tracks = std::move(tracks);
    record.decisions = std::move(decisions);
    record.sprays = std::move(sprays);
    return record;
  };
  std::vector<Case> cases = {
      {Reason::kUndetected, with({}, {})},
      {Reason::kUndetected, with({track(7, 1.0, 0.06)}, {})},  // beyond the association radius
      {Reason::kUnconfirmed, with({track(7, 1.01, 0.0, PlantKind::kWeed, false)}, {})},
      {Reason::kMisclassified, with({track(7, 1.01, 0.0, PlantKind::kCrop)}, {})},
      {Reason::kUnreachable, with({track(7, 1.01, 0.0)}, {})},
      {Reason::kFault, with({track(7, 1.01, 0.0)}, {treat(7)})},
      {Reason::kPlacement,
       with({track(7, 1.01, 0.0)}, {treat(7)}, {spray(1.03, 0.0, {7}, 1.01, 0.0)})},
      // Named no track, but was meant for this place.
      {Reason::kPlacement, with({}, {}, {spray(1.03, 0.0, {}, 1.01, 0.0)})},
      // A spray for a track that is a duplicate of the plant's own.
      {Reason::kPlacement,
       with({track(7, 1.0, 0.0), track(8, 1.04, 0.0)}, {}, {spray(1.04, 0.0, {8}, 1.04, 0.0)})},
      // The last word counts, in whatever order it comes.
      {Reason::kStale, with({track(7, 1.0, 0.0)}, {leave(7, Reason::kStale, 3.0), treat(7, 2.0)})},
  };
  for (const Reason reason : {Reason::kLowPriority, Reason::kProtectedCrop, Reason::kUnreachable,
                              Reason::kStale, Reason::kOutside, Reason::kFault}) {
    cases.push_back({reason, with({track(7, 1.01, 0.0)}, {leave(7, reason)})});
  }
  Case outside{Reason::kOutside, with({track(7, 1.01, 0.0)}, {treat(7)})};
  outside.record.info.reach_y_m = {0.1, 0.7};
  cases.push_back(outside);
  Case end{Reason::kEndOfRun, with({}, {})};
  end.record.info.passed_x_m = {1.5, 9.0};
  cases.push_back(end);

  for (const Case& c : cases) {
    const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.0)}), c.record);
    EXPECT_EQ(row.outcome, Outcome::kMissed);
    EXPECT_EQ(to_string(row.reason), to_string(c.expected));
  }
}

TEST(Account, PlacementDoesNotDependOnTheOrderOfTheNamedTracks) {
  // Both tracks stand for the plant; 8 is a duplicate. The spray lies 20 mm from the plant. It was
  // meant to lie 17 mm from track 7.
  for (const std::vector<std::int64_t>& names : {std::vector<std::int64_t>{7, 8}, {8, 7}}) {
    RunRecord record;
    record.tracks = {track(7, 1.001, 0.0), track(8, 1.03, 0.0)};
    record.sprays = {spray(1.02, 0.0, names, 1.018, 0.0)};
    const auto ledger = account(field_of({plant(1, PlantKind::kWeed, 1.0, 0.0)}), record);
    ASSERT_TRUE(ledger.ok());
    ASSERT_EQ(ledger->placement_errors_mm.size(), 1U);
    EXPECT_NEAR(ledger->placement_errors_mm[0], 3.0, 1e-9);
  }
}

TEST(Account, TracksGoToPlantsOneToOneNearestFirst) {
  // Track 10 is near both plants; track 11 only near the first. Nearest pairs: 10 with 2.
  RunRecord record;
  record.tracks = {track(10, 1.025, 0.0), track(11, 0.98, 0.0)};
  const auto ledger = account(
      field_of({plant(1, PlantKind::kWeed, 1.0, 0.0), plant(2, PlantKind::kWeed, 1.03, 0.0)}),
      record);
  ASSERT_TRUE(ledger.ok());
  EXPECT_EQ(ledger->rows[0].track_id, 11);
  EXPECT_EQ(ledger->rows[1].track_id, 10);
  EXPECT_NEAR(*ledger->rows[1].track_distance_m, 0.005, 1e-12);
}

TEST(Account, ConfirmedTrackIsPreferredToANearerTentativeOne) {
  RunRecord record;
  record.tracks = {track(10, 1.001, 0.0, PlantKind::kWeed, false),
                   track(11, 1.02, 0.0, PlantKind::kCrop)};
  const LedgerRow row = only_row(field_of({plant(1, PlantKind::kWeed, 1.0, 0.0)}), record);
  EXPECT_EQ(row.track_id, 11);
  EXPECT_EQ(row.reason, Reason::kMisclassified);
}

TEST(Account, PlacementErrorLeavesOutTheOffsetThatWasMeant) {
  const auto model =
      field_of({plant(1, PlantKind::kWeed, 1.0, 0.0), plant(2, PlantKind::kWeed, 1.03, 0.0)});
  RunRecord record;
  record.tracks = {track(1, 1.0, 0.0), track(2, 1.03, 0.0)};
  record.sprays = {spray(1.018, 0.0, {1, 2}, 1.015, 0.0)};
  const auto shared = account(model, record);
  ASSERT_TRUE(shared.ok());
  EXPECT_NEAR(*shared->summary.placement_error_p50_mm, 3.0, 1e-9);
  EXPECT_EQ(shared->placement_errors_mm.size(), 2u);
  // The track stands 2 mm beside the plant: vision's error adds to the 3 mm of the actuation.
  record.tracks = {track(2, 1.028, 0.0)};
  record.sprays = {spray(1.018, 0.0, {2}, 1.015, 0.0)};
  const auto single = account(model, record);
  ASSERT_TRUE(single.ok());
  EXPECT_NEAR(*single->summary.placement_error_p50_mm,
              std::abs(1.018 - 1.030 - (1.015 - 1.028)) * 1e3, 1e-9);
  EXPECT_NEAR(*single->summary.aim_error_p95_mm, 3.0, 1e-9);
}

TEST(Account, LossIsSplitBetweenVisionAndPlanning) {
  // 8 weeds: 5 treated, 2 unseen, 1 left on purpose.
  std::vector<field::Plant> plants;
  RunRecord record;
  for (int i = 0; i < 8; ++i) plants.push_back(plant(i, PlantKind::kWeed, i, 0.0));
  for (int i = 0; i < 5; ++i) record.sprays.push_back(spray(i, 0.0));
  record.tracks = {track(5, 5.0, 0.0)};
  record.decisions = {leave(5, Reason::kLowPriority)};
  const auto ledger = account(field_of(plants), record);
  ASSERT_TRUE(ledger.ok());
  EXPECT_DOUBLE_EQ(ledger->summary.loss_pct, 37.5);
  EXPECT_DOUBLE_EQ(ledger->summary.loss_vision_pct, 25.0);
  EXPECT_DOUBLE_EQ(ledger->summary.loss_planning_pct, 12.5);
}

/// A field with tracks, decisions and sprays of every quality.
std::pair<field::FieldModel, RunRecord> random_run(std::uint64_t seed, int plants,
                                                   double length_m) {
  Random random(seed, "run");
  std::pair<field::FieldModel, RunRecord> run;
  run.first = field_of({});
  run.first.length_m = length_m;
  for (int i = 0; i < plants; ++i) {
    const PlantKind kind = random.bernoulli(0.2) ? PlantKind::kCrop : PlantKind::kWeed;
    run.first.plants.push_back(
        plant(i, kind, random.uniform(0.0, length_m), random.uniform(-0.7, 0.7)));
    const Eigen::Vector2d& p_F = run.first.plants.back().p_F_m;
    const int tracks = static_cast<int>(random.integer(0, 2));
    for (int k = 0; k < tracks; ++k) {
      TrackView view =
          track(10 * i + k, p_F.x() + random.normal(0.0, 0.01), p_F.y() + random.normal(0.0, 0.01));
      view.confirmed = random.bernoulli(0.9);
      view.kind = random.bernoulli(0.9) ? kind : PlantKind::kCrop;
      if (random.bernoulli(0.6)) {
        Spray s = spray(p_F.x() + random.normal(0.0, 0.012), p_F.y() + random.normal(0.0, 0.012),
                        {view.id}, p_F.x(), p_F.y());
        s.axis = static_cast<int>(random.integer(0, 3));
        s.time = Time::from_seconds(p_F.x() / 0.5);
        run.second.sprays.push_back(s);
        run.second.decisions.push_back(treat(view.id, s.time.to_seconds()));
      } else if (random.bernoulli(0.8)) {
        run.second.decisions.push_back(
            leave(view.id, static_cast<Reason>(random.integer(4, 11)), random.uniform()));
      }
      run.second.tracks.push_back(view);
    }
  }
  run.second.info.passed_x_m = {0.2, length_m - 0.2};
  run.second.info.reach_y_m = {-0.695, 0.695};
  return run;
}

template <class T>
void shuffle(std::vector<T>& items, Random& random) {
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1],
              items[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i) - 1))]);
  }
}

TEST(Account, EveryPlantIsAccountedForInAnyOrderOfInput) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    auto [model, record] = random_run(seed, 150, 3.0);
    const auto ledger = account(model, record);
    ASSERT_TRUE(ledger.ok());
    ASSERT_EQ(ledger->rows.size(), model.plants.size());
    for (const LedgerRow& row : ledger->rows) {
      const bool weed = row.kind == PlantKind::kWeed;
      EXPECT_EQ(weed, row.outcome != Outcome::kSpared && row.outcome != Outcome::kHit);
      EXPECT_EQ(row.outcome == Outcome::kMissed, row.reason != Reason::kNone);
    }
    const Summary& s = ledger->summary;
    EXPECT_EQ(s.treated_accurate + s.treated_partial + s.missed, s.weeds_total);
    EXPECT_EQ(std::accumulate(s.missed_by_reason.begin(), s.missed_by_reason.end(), 0L), s.missed);
    EXPECT_EQ(s.missed_by_reason[0], 0);
    EXPECT_NEAR(s.loss_planning_pct + s.loss_vision_pct, s.loss_pct, 1e-9);
    EXPECT_EQ(s.weeds_total + s.crops_total, static_cast<std::int64_t>(model.plants.size()));
    EXPECT_EQ(std::accumulate(s.sprays_by_axis.begin(), s.sprays_by_axis.end(), 0L), s.sprays);

    Random random(seed, "shuffle");
    shuffle(model.plants, random);
    shuffle(record.tracks, random);
    shuffle(record.decisions, random);
    shuffle(record.sprays, random);
    const auto again = account(model, record);
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(to_csv(*again), to_csv(*ledger));
    EXPECT_EQ(to_json(again->summary), to_json(ledger->summary));
  }
}

TEST(Account, TreatmentAgreesWithAnExhaustiveSearch) {
  const auto [model, record] = random_run(99, 400, 5.0);
  const auto ledger = account(model, record);
  ASSERT_TRUE(ledger.ok());
  for (const LedgerRow& row : ledger->rows) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Spray& s : record.sprays) {
      nearest_m = std::min(nearest_m, (s.p_F_m - row.p_F_m).norm());
    }
    const bool weed = row.kind == PlantKind::kWeed;
    const Outcome expected = nearest_m <= 0.010   ? Outcome::kAccurate
                             : nearest_m <= 0.025 ? Outcome::kPartial
                                                  : Outcome::kMissed;
    if (weed) {
      EXPECT_EQ(row.outcome, expected);
    } else {
      EXPECT_EQ(row.outcome == Outcome::kHit, nearest_m <= 0.025);
    }
  }
}

/// Of this thread, so that other work on the machine does not count. The shortest of three.
double cpu_time_of_account_s(int plants) {
  const auto [model, record] = random_run(5, plants, 0.01 * plants);
  double shortest_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double start_s = thread_cpu_s();
    EXPECT_TRUE(account(model, record).ok());
    shortest_s = std::min(shortest_s, thread_cpu_s() - start_s);
  }
  return shortest_s;
}

// Comparing each plant with each spray would make it sixteen times.
TEST(Account, FourTimesThePlantsTakeLessThanEightTimesTheWork) {
  const double quarter_s = cpu_time_of_account_s(25'000);
  const double whole_s = cpu_time_of_account_s(100'000);
  EXPECT_LT(whole_s, 8.0 * quarter_s);
}

TEST(Account, EmptyRun) {
  const auto ledger = account(field_of({}), {});
  ASSERT_TRUE(ledger.ok());
  EXPECT_TRUE(ledger->rows.empty());
  EXPECT_EQ(ledger->summary.loss_pct, 0.0);
  EXPECT_FALSE(ledger->summary.placement_error_p50_mm.has_value());
}

TEST(Account, WithoutTruthTheConfirmedTracksStandForThePlants) {
  RunRecord record;
  record.tracks = {track(1, 1.0, 0.0), track(2, 2.0, 0.0),
                   track(3, 3.0, 0.0, PlantKind::kWeed, false),
                   track(4, 4.0, 0.0, PlantKind::kCrop)};
  record.decisions = {treat(1), leave(2, Reason::kUnreachable)};
  record.sprays = {spray(1.002, 0.0, {1}, 1.0, 0.0)};
  const auto ledger = account_tracks(field_of({plant(9, PlantKind::kWeed, 9.0, 0.0)}), record);
  ASSERT_TRUE(ledger.ok());
  EXPECT_FALSE(ledger->summary.against_truth);
  EXPECT_FALSE(ledger->summary.placement_error_p50_mm.has_value());
  EXPECT_TRUE(ledger->placement_errors_mm.empty());
  const std::string json = to_json(ledger->summary);
  EXPECT_NE(json.find(R"("loss_vision_pct": null)"), std::string::npos) << json;
  ASSERT_EQ(ledger->rows.size(), 3u);
  EXPECT_EQ(ledger->rows[0].outcome, Outcome::kAccurate);
  EXPECT_EQ(ledger->rows[1].reason, Reason::kUnreachable);
  EXPECT_EQ(ledger->rows[2].outcome, Outcome::kSpared);
}

TEST(Account, RefusesWhatItCannotAccountFor) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto good = field_of({plant(1, PlantKind::kWeed, 1.0, 0.0)});
  const auto message = [](const Result<Ledger>& result) {
    return result.ok() ? std::string("accepted") : result.error().message;
  };
  EXPECT_NE(message(account(field_of({plant(4, PlantKind::kWeed, nan, 0.0)}), {})).find("plant 4"),
            std::string::npos);
  EXPECT_NE(message(account(field_of({plant(4, PlantKind::kWeed, 0.0, 0.0),
                                      plant(4, PlantKind::kCrop, 1.0, 0.0)}),
                            {}))
                .find("two plants have the id 4"),
            std::string::npos);
  RunRecord record;
  record.tracks = {track(3, 1e9, 0.0)};
  EXPECT_NE(message(account(good, record)).find("track 3"), std::string::npos);
  record = {};
  record.sprays = {spray(1.0, nan)};
  EXPECT_NE(message(account(good, record)).find("spray of axis 0"), std::string::npos);
  record.sprays = {spray(1.0, 0.0)};
  record.sprays[0].axis = -1;
  EXPECT_NE(message(account(good, record)).find("axis -1"), std::string::npos);
  record.sprays[0].axis = 0;
  record.sprays[0].radius_m = 1e3;
  EXPECT_NE(message(account(good, record)).find("footprint radius"), std::string::npos);
  record = {};
  record.decisions = {leave(3, Reason::kNone)};
  EXPECT_NE(message(account(good, record)).find("gives no reason"), std::string::npos);
  EXPECT_NE(message(account(good, {}, {.accurate_radius_m = nan})).find("radius"),
            std::string::npos);
}

TEST(Account, ReasonNamesGoBothWays) {
  for (std::size_t i = 0; i < kReasonCount; ++i) {
    const auto reason = static_cast<Reason>(i);
    EXPECT_EQ(reason_from_string(to_string(reason)), reason);
  }
  EXPECT_FALSE(reason_from_string("tired").has_value());
}

}  // namespace
}  // namespace furrow::ledger::test
