// Invalid observations, views and parameters do not disturb the tracker.

#include <gtest/gtest.h>

#include <limits>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"
#include "tracker_inputs.hpp"

namespace furrow::tracking {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Tracker, RejectsInvalidObservationsAndUsesTheOthers) {
  Observations observations(14, seen_at(0.0, 0.0));
  observations[0].p_F_m.x() = kNan;
  observations[1].p_F_m.y() = std::numeric_limits<double>::infinity();
  observations[2].radius_m = -0.01;
  observations[3].radius_m = kNan;
  observations[4].covariance_F_m2.setZero();
  observations[5].covariance_F_m2 << 1e-6, 2e-6, 2e-6, 1e-6;
  observations[6].covariance_F_m2(0, 1) = kNan;
  observations[7].score = 1.5;
  observations[8].class_probability = {0.0, 0.0};
  observations[9].class_probability = {-0.1, 1.1};
  observations[10].area_mm2 = -1.0;
  observations[11].species_probability = {kNan};
  observations[12].covariance_F_m2 = -observations[12].covariance_F_m2;
  Tracker tracker;
  const UpdateSummary summary = tracker.update(view_at(0.2), observations);
  EXPECT_EQ(summary.rejected, 13);
  EXPECT_EQ(summary.born, 1);
  EXPECT_FALSE(summary.ok());
  EXPECT_EQ(tracker.observation_track_ids()[13], tracker.tracks()[0].id);
}

TEST(Tracker, AViewWithAFaultChangesNothing) {
  Tracker tracker;
  tracker.update(view_at(1.0), Observations{seen_at(0.0, 0.0)});
  const auto fault_of = [&](const View& view) {
    const UpdateSummary summary = tracker.update(view, Observations{seen_at(0.3, 0.0)});
    EXPECT_FALSE(summary.ok());
    EXPECT_EQ(tracker.tracks().size(), 1U);
    EXPECT_EQ(tracker.observation_track_ids()[0], 0U);
    return summary.fault;
  };
  EXPECT_EQ(fault_of(view_at(1.0)), ViewFault::kTimeNotNewer);
  EXPECT_EQ(fault_of(view_at(0.5)), ViewFault::kTimeNotNewer);
  View view = view_at(2.0);
  view.X_FB.heading_rad = kNan;
  EXPECT_EQ(fault_of(view), ViewFault::kBadPose);
  view = view_at(2.0);
  view.pose_covariance(1, 1) = -1.0;
  EXPECT_EQ(fault_of(view), ViewFault::kBadCovariance);
  view.pose_covariance = Eigen::Matrix3d::Constant(kNan);
  EXPECT_EQ(fault_of(view), ViewFault::kBadCovariance);
  view.pose_covariance = Eigen::Matrix3d::Identity();
  view.pose_covariance(0, 1) = 0.5;
  EXPECT_EQ(fault_of(view), ViewFault::kBadCovariance);
  EXPECT_EQ(tracker.update(view_at(1.1), {}).fault, ViewFault::kNone);
}

TEST(Tracker, RefusesParametersOutOfRangeOrInContradiction) {
  TrackerParameters parameters;
  parameters.association = "nearest";
  EXPECT_THROW(Tracker{parameters}, ConfigError);
  parameters = {};
  parameters.min_radius_m = 0.06;
  EXPECT_THROW(Tracker{parameters}, ConfigError);
  parameters = {};
  parameters.match_score = 0.9;
  EXPECT_THROW(Tracker{parameters}, ConfigError);
  parameters = {};
  parameters.confirm_matches = 0;
  EXPECT_THROW(Tracker{parameters}, ConfigError);
}

TEST(Tracker, SurvivesRandomInput) {
  Random random(99);
  Tracker tracker;
  const auto any = [&](double scale) {
    switch (random.integer(0, 9)) {
      case 0:
        return kNan;
      case 1:
        return -std::numeric_limits<double>::infinity();
      case 2:
        return 1e300;
      default:
        return random.normal(0.0, scale);
    }
  };
  for (int i = 0; i < 2000; ++i) {
    View view = view_at(0.2 * i);
    if (random.bernoulli(0.1)) view.X_FB.x_m = any(10.0);
    if (random.bernoulli(0.1)) view.pose_covariance(0, 0) = any(1.0);
    Observations observations;
    for (std::int64_t k = random.integer(0, 20); k > 0; --k) {
      Observation observation = seen_at(random.normal(0.0, 0.3), random.normal(0.0, 0.3));
      if (random.bernoulli(0.2)) observation.p_F_m.x() = any(1.0);
      if (random.bernoulli(0.2)) observation.radius_m = any(0.1);
      if (random.bernoulli(0.2)) observation.covariance_F_m2(0, 0) = any(1e-3);
      if (random.bernoulli(0.2)) observation.score = any(1.0);
      if (random.bernoulli(0.2)) observation.class_probability[0] = any(1.0);
      observations.push_back(observation);
    }
    tracker.update(view, observations);
    for (const Track& track : tracker.tracks()) {
      ASSERT_TRUE(track.p_F_m.allFinite());
      ASSERT_GT(track.covariance_F_m2.determinant(), 0.0);
      ASSERT_NEAR(track.class_probability[0] + track.class_probability[1], 1.0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace furrow::tracking
