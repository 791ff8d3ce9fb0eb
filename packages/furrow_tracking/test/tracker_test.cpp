#include "furrow_tracking/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tracker_inputs.hpp"

namespace furrow::tracking {
namespace {

TEST(Tracker, ATrackIsBornConfirmedCoastsAndEnds) {
  Tracker tracker;
  UpdateSummary summary = tracker.update(view_at(0.2), Observations{seen_at(0.1, 0.2)});
  EXPECT_EQ(summary.born, 1);
  ASSERT_EQ(tracker.tracks().size(), 1U);
  EXPECT_EQ(tracker.tracks()[0].state, TrackState::kTentative);
  EXPECT_EQ(tracker.observation_track_ids()[0], tracker.tracks()[0].id);
  tracker.update(view_at(0.4), Observations{seen_at(0.1, 0.2)});
  summary = tracker.update(view_at(0.6), Observations{seen_at(0.1, 0.2)});
  EXPECT_EQ(summary.matched, 1);
  EXPECT_EQ(summary.confirmed, 1);
  EXPECT_EQ(tracker.tracks()[0].state, TrackState::kConfirmed);
  EXPECT_EQ(tracker.tracks()[0].views, 3);
  for (int i = 1; i <= 4; ++i) {
    summary = tracker.update(view_at(0.6 + 0.2 * i), {});
    EXPECT_TRUE(summary.empty_view);
    EXPECT_EQ(summary.missed, 1);
    EXPECT_EQ(tracker.tracks()[0].state, TrackState::kCoasting);
    EXPECT_EQ(tracker.tracks()[0].misses, i);
  }
  summary = tracker.update(view_at(2.0), {});
  EXPECT_EQ(summary.dropped, 1);
  EXPECT_TRUE(tracker.tracks().empty());
  ASSERT_EQ(tracker.ended().size(), 1U);
  EXPECT_EQ(tracker.ended()[0].end_reason, EndReason::kMissed);
  EXPECT_TRUE(tracker.ended()[0].confirmed);
  tracker.update(view_at(2.2), {});
  EXPECT_TRUE(tracker.ended().empty());
}

TEST(Tracker, AMatchResetsTheMisses) {
  Tracker tracker;
  double t_s = 0.0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) {
      tracker.update(view_at(t_s += 0.2), Observations{seen_at(0.0, 0.0)});
    }
    tracker.update(view_at(t_s += 0.2), {});
  }
  ASSERT_EQ(tracker.tracks().size(), 1U);
  EXPECT_EQ(tracker.tracks()[0].misses_total, 10);
}

TEST(Tracker, MissesCountOnlyWhereThePlantShouldBeSeen) {
  Tracker tracker;
  for (int i = 1; i <= 3; ++i) {
    tracker.update(view_at(0.2 * i), Observations{seen_at(0.99, 0.0), seen_at(0.5, 0.0)});
  }
  // 0.99 lies within the margin of the edge at 1.0.
  const UpdateSummary summary = tracker.update(view_at(0.8), {});
  EXPECT_EQ(summary.missed, 1);
  View elsewhere = view_at(1.0);
  elsewhere.visible = *GroundRegion::from_bounds({3.0, -1.0}, {4.0, 1.0});
  EXPECT_EQ(tracker.update(elsewhere, {}).missed, 0);
  elsewhere.visible = GroundRegion();
  elsewhere.stamp = Time::from_seconds(1.2);
  EXPECT_EQ(tracker.update(elsewhere, {}).missed, 0);
}

TEST(Tracker, PlantsFarBehindEnd) {
  TrackerParameters parameters;
  parameters.keep_distance_m = 2.0;
  Tracker tracker(parameters);
  for (int i = 1; i <= 3; ++i) tracker.update(view_at(0.2 * i), Observations{seen_at(0.0, 0.0)});
  View later = view_at(1.0);
  later.visible = GroundRegion();
  later.X_FB.x_m = 1.9;
  EXPECT_EQ(tracker.update(later, {}).passed, 0);
  later.stamp = Time::from_seconds(1.2);
  later.X_FB.x_m = 2.1;
  EXPECT_EQ(tracker.update(later, {}).passed, 1);
  EXPECT_EQ(tracker.ended()[0].end_reason, EndReason::kPassed);
}

TEST(Tracker, PositionIsTheMeanOfEqualViews) {
  TrackerParameters parameters;
  parameters.drift_m_per_sqrt_s = 0.0;
  parameters.position_floor_m = 0.0;
  Tracker tracker(parameters);
  const double offsets[] = {0.001, -0.002, 0.0005, 0.0015};
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    tracker.update(view_at(0.2 * (i + 1)), Observations{seen_at(offsets[i], 0.0)});
    sum += offsets[i];
  }
  EXPECT_NEAR(tracker.tracks()[0].p_F_m.x(), sum / 4.0, 1e-12);
  EXPECT_NEAR(tracker.tracks()[0].covariance_F_m2(0, 0), 1e-6 / 4.0, 1e-15);
}

TEST(Tracker, PoseErrorWidensTheCovarianceOfDistantPlants) {
  Tracker tracker;
  View view = view_at(0.2);
  view.pose_covariance(2, 2) = 1e-4;  // 0.01 rad
  tracker.update(view, Observations{seen_at(0.8, 0.0)});
  const Eigen::Matrix2d& P = tracker.tracks()[0].covariance_F_m2;
  EXPECT_NEAR(P(0, 0), 1e-6, 1e-12);
  EXPECT_NEAR(P(1, 1), 1e-6 + 0.64 * 1e-4, 1e-12);
}

TEST(Tracker, OneWrongViewDoesNotDecideTheClass) {
  Tracker tracker;
  double t_s = 0.0;
  for (const double crop : {0.3, 1.0, 0.3, 0.2, 0.3}) {
    Observation observation = seen_at(0.0, 0.0);
    observation.class_probability = {crop, 1.0 - crop};
    tracker.update(view_at(t_s += 0.2), Observations{observation});
  }
  // Odds by view: 3/7, 0.9/0.1 (floored), 3/7, 2/8, 3/7.
  const double odds = std::pow(3.0 / 7.0, 3) * 9.0 * 0.25;
  const Track& track = tracker.tracks()[0];
  EXPECT_NEAR(track.class_probability[0], odds / (1.0 + odds), 1e-12);
  EXPECT_EQ(track.plant_class(), PlantClass::kWeed);
}

TEST(Tracker, ClassEvidenceIsBoundedSoThatItCanBeReversed) {
  Tracker tracker;
  double t_s = 0.0;
  Observation observation = seen_at(0.0, 0.0);
  for (int i = 0; i < 100; ++i) {
    tracker.update(view_at(t_s += 0.2), Observations{observation});
  }
  observation.class_probability = {1.0, 0.0};
  int views = 0;
  while (tracker.tracks()[0].plant_class() == PlantClass::kWeed) {
    tracker.update(view_at(t_s += 0.2), Observations{observation});
    ++views;
  }
  EXPECT_EQ(views, static_cast<int>(std::ceil(8.0 / std::log(9.0))));
}

TEST(Tracker, FusesTheSpeciesOfItsViews) {
  Tracker tracker;
  double t_s = 0.0;
  Observation observation = seen_at(0.0, 0.0);
  tracker.update(view_at(t_s += 0.2), Observations{observation});
  EXPECT_EQ(most_probable_species(tracker.tracks()[0]), -1);
  const std::vector<std::vector<float>> views = {{0.1F, 0.9F}, {0.6F, 0.3F, 0.1F}, {0.2F, 0.7F}};
  for (const std::vector<float>& probabilities : views) {
    observation.species_probability = probabilities;
    tracker.update(view_at(t_s += 0.2), Observations{observation});
  }
  EXPECT_EQ(most_probable_species(tracker.tracks()[0]), 1);
  EXPECT_DOUBLE_EQ(tracker.tracks()[0].species_views, 3.0);
}

TEST(Tracker, AWholeSizeReplacesATruncatedOne) {
  Tracker tracker;
  Observation cut = seen_at(0.0, 0.0, 0.008);
  cut.truncated = true;
  cut.area_mm2 = 80.0;
  tracker.update(view_at(0.2), Observations{cut});
  EXPECT_EQ(tracker.tracks()[0].radius_m, 0.008);
  tracker.update(view_at(0.4), Observations{seen_at(0.0, 0.0, 0.012)});
  EXPECT_EQ(tracker.tracks()[0].radius_m, 0.012);
  EXPECT_EQ(tracker.tracks()[0].area_mm2, 200.0);
  tracker.update(view_at(0.6), Observations{cut});
  EXPECT_EQ(tracker.tracks()[0].radius_m, 0.012);
  EXPECT_EQ(tracker.tracks()[0].whole_views, 1);
}

TEST(Tracker, TheRadiusDecidesHowFarAPlantMayMove) {
  const auto matches = [](const std::string& association, double radius_m, double distance_m) {
    TrackerParameters parameters;
    parameters.association = association;
    parameters.uncertainty_gain = 0.0;
    Tracker tracker(parameters);
    tracker.update(view_at(0.2), Observations{seen_at(0.0, 0.0, radius_m)});
    return tracker.update(view_at(0.4), Observations{seen_at(distance_m, 0.0, radius_m)}).matched;
  };
  EXPECT_EQ(matches("dynamic_radius", 0.02, 0.019), 1);
  EXPECT_EQ(matches("dynamic_radius", 0.02, 0.021), 0);
  EXPECT_EQ(matches("dynamic_radius", 0.001, 0.009), 1);  // the least radius
  EXPECT_EQ(matches("dynamic_radius", 0.20, 0.049), 1);
  EXPECT_EQ(matches("dynamic_radius", 0.20, 0.051), 0);  // the greatest radius
  EXPECT_EQ(matches("fixed_radius", 0.001, 0.029), 1);
  EXPECT_EQ(matches("fixed_radius", 0.20, 0.031), 0);
  EXPECT_EQ(matches("iou", 0.02, 0.02), 1);
  EXPECT_EQ(matches("iou", 0.005, 0.02), 0);
}

TEST(Tracker, IouUsesFootprintsWhereBothHaveOne) {
  TrackerParameters parameters;
  parameters.association = "iou";
  Tracker tracker(parameters);
  Observation observation = seen_at(0.0, 0.0, 0.01);
  observation.footprint = GroundMask::from_circle({0.0, 0.0}, 0.01, 0.001);
  tracker.update(view_at(0.2), Observations{observation});
  // The stems are near, the footprints apart.
  observation.footprint = GroundMask::from_circle({0.1, 0.0}, 0.01, 0.001);
  EXPECT_EQ(tracker.update(view_at(0.4), Observations{observation}).matched, 0);
}

TEST(Tracker, TwoObservationsOfOnePlantMakeOneTrack) {
  Tracker tracker;
  UpdateSummary summary =
      tracker.update(view_at(0.2), Observations{seen_at(0.0, 0.0), seen_at(0.002, 0.0)});
  EXPECT_EQ(summary.born, 1);
  EXPECT_EQ(summary.duplicates, 1);
  summary = tracker.update(view_at(0.4), Observations{seen_at(0.0, 0.0), seen_at(0.002, 0.0)});
  EXPECT_EQ(summary.matched, 1);
  EXPECT_EQ(summary.duplicates, 1);
  // A small weed at the foot of a large crop is a plant of its own.
  summary = tracker.update(view_at(0.6),
                           Observations{seen_at(0.5, 0.5, 0.05), seen_at(0.51, 0.5, 0.006)});
  EXPECT_EQ(summary.born, 2);
}

TEST(Tracker, AMissedTrackMergesWithItsDuplicate) {
  TrackerParameters parameters;
  parameters.uncertainty_gain = 0.0;
  parameters.outlier_sigma = 100.0;
  Tracker tracker(parameters);
  for (int i = 1; i <= 3; ++i) tracker.update(view_at(0.2 * i), Observations{seen_at(0.0, 0.0)});
  const std::uint64_t id = tracker.tracks()[0].id;
  // The plant appears beyond the gate, as after a jump of the pose, then on the other side: the
  // new track's mean comes to lie on the old one.
  tracker.update(view_at(0.8), Observations{seen_at(0.0102, 0.0, 0.03)});
  ASSERT_EQ(tracker.tracks().size(), 2U);
  const UpdateSummary summary =
      tracker.update(view_at(1.0), Observations{seen_at(-0.012, 0.0, 0.03)});
  EXPECT_EQ(summary.merged, 1);
  ASSERT_EQ(tracker.tracks().size(), 1U);
  EXPECT_EQ(tracker.tracks()[0].id, id);
  EXPECT_EQ(tracker.tracks()[0].views, 5);
  ASSERT_EQ(tracker.ended().size(), 1U);
  EXPECT_EQ(tracker.ended()[0].merged_into, id);
  EXPECT_EQ(tracker.observation_track_ids()[0], id);
}

TEST(Tracker, WeakObservationsMatchButStartNoTrack) {
  Tracker tracker;
  Observation weak = seen_at(0.0, 0.0);
  weak.score = 0.4;
  EXPECT_EQ(tracker.update(view_at(0.2), Observations{weak}).weak, 1);
  EXPECT_TRUE(tracker.tracks().empty());
  tracker.update(view_at(0.4), Observations{seen_at(0.0, 0.0)});
  EXPECT_EQ(tracker.update(view_at(0.6), Observations{weak}).matched, 1);
  weak.score = 0.2;
  EXPECT_EQ(tracker.update(view_at(0.8), Observations{weak}).weak, 1);
}

TEST(Tracker, KeepsTheNearestTracksWhenFull) {
  TrackerParameters parameters;
  parameters.max_tracks = 10;
  parameters.max_observations = 25;
  Tracker tracker(parameters);
  Observations observations;
  for (int i = 0; i < 30; ++i) observations.push_back(seen_at(0.03 * (i + 1), 0.0));
  const UpdateSummary summary = tracker.update(view_at(0.2), observations);
  EXPECT_EQ(summary.overflow, 5);
  EXPECT_EQ(summary.born, 25);
  EXPECT_EQ(summary.evicted, 15);
  ASSERT_EQ(tracker.tracks().size(), 10U);
  for (const Track& track : tracker.tracks()) EXPECT_LT(track.p_F_m.x(), 0.305);
}

TEST(Tracker, FinishEndsEveryTrack) {
  Tracker tracker;
  tracker.update(view_at(0.2), Observations{seen_at(0.0, 0.0), seen_at(0.5, 0.0)});
  tracker.finish();
  EXPECT_TRUE(tracker.tracks().empty());
  ASSERT_EQ(tracker.ended().size(), 2U);
  EXPECT_EQ(tracker.ended()[0].end_reason, EndReason::kFinished);
}

}  // namespace
}  // namespace furrow::tracking
