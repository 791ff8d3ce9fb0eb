#include "furrow_tracking/metrics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "furrow_core/error.hpp"

namespace furrow::tracking {
namespace {

LabelledPoint at(std::int64_t id, double x_m) {
  return {id, {x_m, 0.0}};
}
using Frame = std::vector<LabelledPoint>;

TEST(TrackingEvaluation, PerfectTracksScoreOne) {
  TrackingEvaluation evaluation(0.02);
  for (int frame = 0; frame < 5; ++frame) {
    ASSERT_TRUE(
        evaluation.add_frame(Frame{at(1, 0.0), at(2, 1.0)}, Frame{at(7, 0.0), at(9, 1.0)}).ok());
  }
  const TrackingScores scores = evaluation.scores();
  EXPECT_EQ(scores.truth_points, 10);
  EXPECT_DOUBLE_EQ(scores.mota, 1.0);
  EXPECT_DOUBLE_EQ(scores.idf1, 1.0);
  EXPECT_NEAR(scores.hota, 1.0, 1e-12);
}

TEST(TrackingEvaluation, ASwitchHalfWayCostsWhatTheDefinitionsSay) {
  // One plant over 4 frames; track 1 in the first two, track 2 in the last two.
  TrackingEvaluation evaluation(0.02);
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{at(frame < 2 ? 1 : 2, 0.0)}).ok());
  }
  const TrackingScores scores = evaluation.scores();
  EXPECT_EQ(scores.id_switches, 1);
  EXPECT_DOUBLE_EQ(scores.mota, 1.0 - 1.0 / 4.0);
  // IDTP = 2 of 4 points on each side: 2 * 2 / 8.
  EXPECT_DOUBLE_EQ(scores.idf1, 0.5);
  // Each match has TPA 2, FNA 2, FPA 0: A = 1/2; DetA = 1.
  EXPECT_NEAR(scores.detection_accuracy, 1.0, 1e-12);
  EXPECT_NEAR(scores.association_accuracy, 0.5, 1e-12);
  EXPECT_NEAR(scores.hota, std::sqrt(0.5), 1e-12);
}

TEST(TrackingEvaluation, CountsMissesAndGhosts) {
  // 4 frames, two plants; plant 2 is never tracked, and a ghost stands at x = 5 in one frame.
  TrackingEvaluation evaluation(0.02);
  for (int frame = 0; frame < 4; ++frame) {
    Frame tracks = {at(1, 0.0)};
    if (frame == 2) tracks.push_back(at(3, 5.0));
    ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0), at(2, 1.0)}, tracks).ok());
  }
  const TrackingScores scores = evaluation.scores();
  EXPECT_EQ(scores.false_negatives, 4);
  EXPECT_EQ(scores.false_positives, 1);
  EXPECT_EQ(scores.id_switches, 0);
  EXPECT_DOUBLE_EQ(scores.mota, 1.0 - 5.0 / 8.0);
  // IDTP 4, IDFN 4, IDFP 1.
  EXPECT_DOUBLE_EQ(scores.idf1, 8.0 / 13.0);
  // DetA = 4 / (4 + 4 + 1); AssA = 1.
  EXPECT_NEAR(scores.hota, std::sqrt(4.0 / 9.0), 1e-12);
}

TEST(TrackingEvaluation, HotaFallsWithDistance) {
  // Similarity 1 - 0.6: matched at the thresholds 0.05 ... 0.40, which are 8 of 19.
  TrackingEvaluation evaluation(0.02);
  ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{at(1, 0.012)}).ok());
  const TrackingScores scores = evaluation.scores();
  EXPECT_NEAR(scores.hota, 8.0 / 19.0, 1e-12);
  EXPECT_DOUBLE_EQ(scores.mota, -1.0);  // one miss and one ghost for one plant
  EXPECT_DOUBLE_EQ(scores.idf1, 0.0);
}

TEST(TrackingEvaluation, AMatchOfTheFrameBeforeGoesFirst) {
  // In the second frame another track is nearer, but the first is still near enough.
  TrackingEvaluation evaluation(0.02);
  ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{at(1, 0.0)}).ok());
  ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{at(1, 0.008), at(2, 0.001)}).ok());
  EXPECT_EQ(evaluation.scores().id_switches, 0);
}

TEST(TrackingEvaluation, AReturnAfterAGapUnderAnotherIdIsASwitch) {
  TrackingEvaluation evaluation(0.02);
  ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{at(1, 0.0)}).ok());
  ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{}).ok());
  ASSERT_TRUE(evaluation.add_frame(Frame{at(1, 0.0)}, Frame{at(2, 0.0)}).ok());
  const TrackingScores scores = evaluation.scores();
  EXPECT_EQ(scores.id_switches, 1);
  EXPECT_EQ(scores.false_negatives, 1);
}

TEST(TrackingEvaluation, PairsEachPlantWithTheTrackThatStaysNearest) {
  // Tracks 7 and 8 stand within reach of plants 1 and 2 alike; plant 3 was not found, though the
  // track of plant 2 is near.
  TrackingEvaluation evaluation(0.05);
  const Frame truth = {at(1, 0.0), at(2, 0.010), at(3, 0.020)};
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_TRUE(evaluation.add_frame(truth, Frame{at(8, 0.002), at(7, 0.011)}).ok());
  }
  const auto pairs = evaluation.identity_pairs();
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].truth_id, 1);
  EXPECT_EQ(pairs[0].track_id, 8);
  EXPECT_EQ(pairs[1].truth_id, 2);
  EXPECT_EQ(pairs[1].track_id, 7);
}

TEST(TrackingEvaluation, NothingToFindAndNothingClaimedIsPerfect) {
  TrackingEvaluation evaluation(0.02);
  EXPECT_DOUBLE_EQ(evaluation.scores().mota, 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().idf1, 1.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().hota, 1.0);
  ASSERT_TRUE(evaluation.add_frame(Frame{}, Frame{at(1, 0.0)}).ok());
  EXPECT_LT(evaluation.scores().mota, 0.0);
  EXPECT_DOUBLE_EQ(evaluation.scores().hota, 0.0);
}

TEST(TrackingEvaluation, RefusesBadFrames) {
  TrackingEvaluation evaluation(0.02);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(evaluation.add_frame(Frame{at(1, nan)}, Frame{}).ok());
  EXPECT_FALSE(evaluation.add_frame(Frame{}, Frame{at(1, 0.0), at(1, 1.0)}).ok());
  EXPECT_EQ(evaluation.scores().frames, 0);
  EXPECT_THROW(TrackingEvaluation(0.0), ConfigError);
  EXPECT_THROW(TrackingEvaluation{nan}, ConfigError);
}

TEST(CountNae, IsTheShareOfWronglyCounted) {
  using Counts = std::array<std::int64_t, 3>;
  EXPECT_DOUBLE_EQ(*count_nae_pct(Counts{10, 20, 70}, Counts{11, 18, 70}), 3.0);
  EXPECT_DOUBLE_EQ(*count_nae_pct(Counts{0, 0, 0}, Counts{0, 0, 0}), 0.0);
  EXPECT_TRUE(std::isinf(*count_nae_pct(Counts{0, 0, 0}, Counts{0, 1, 0})));
  EXPECT_FALSE(count_nae_pct({}, {}).ok());
  EXPECT_FALSE(count_nae_pct(Counts{1, 2, 3}, std::array<std::int64_t, 1>{1}).ok());
  EXPECT_FALSE(count_nae_pct(Counts{1, 2, -3}, Counts{1, 2, 3}).ok());
}

}  // namespace
}  // namespace furrow::tracking
