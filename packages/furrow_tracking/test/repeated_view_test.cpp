// Views of a robot that stands.
#include <gtest/gtest.h>

#include "tracker_inputs.hpp"

namespace furrow::tracking {
namespace {

TrackerParameters parameters() {
  TrackerParameters parameters;
  parameters.repeat_distance_m = 0.002;
  parameters.confirm_matches = 2;
  parameters.confirmed_misses = 3;
  parameters.tentative_misses = 3;
  return parameters;
}

View view_from(double t_s, double x_m, double heading_rad = 0.0) {
  View view = view_at(t_s);
  view.X_FB = {x_m, 0.0, heading_rad};
  return view;
}

/// One plant, confirmed by views from x = 0 m and 0.1 m, at 0.1 s and 0.2 s.
Tracker with_a_plant() {
  Tracker tracker(parameters());
  (void)tracker.update(view_from(0.1, 0.0), Observations{seen_at(0.5, 0.0)});
  (void)tracker.update(view_from(0.2, 0.1), Observations{seen_at(0.5, 0.0)});
  return tracker;
}

TEST(RepeatedView, RefinesNothingAndKeepsTheTrackFresh) {
  Tracker tracker = with_a_plant();
  const Track before = tracker.tracks()[0];
  ASSERT_TRUE(before.confirmed);
  for (int i = 0; i < 600; ++i) {
    const UpdateSummary summary =
        tracker.update(view_from(0.3 + 0.1 * i, 0.1), Observations{seen_at(0.503, 0.0)});
    EXPECT_TRUE(summary.repeated_view);
    EXPECT_EQ(summary.matched, 1);
  }
  ASSERT_EQ(tracker.tracks().size(), 1U);
  const Track& after = tracker.tracks()[0];
  EXPECT_EQ(after.p_F_m, before.p_F_m);
  EXPECT_EQ(after.covariance_F_m2, before.covariance_F_m2);
  EXPECT_EQ(after.class_log_odds, before.class_log_odds);
  EXPECT_EQ(after.views, before.views);
  EXPECT_EQ(after.last_seen, Time::from_seconds(0.3 + 0.1 * 599));
}

// A crop that the detector misses from one viewpoint must stay protected.
TEST(RepeatedView, DeletesNoPlantThatIsMissedFromOneViewpoint) {
  Tracker tracker = with_a_plant();
  for (int i = 0; i < 600; ++i) {
    EXPECT_EQ(tracker.update(view_from(0.3 + 0.1 * i, 0.1), {}).missed, 0);
  }
  EXPECT_EQ(tracker.tracks().size(), 1U);
}

TEST(RepeatedView, ConfirmsNoPlantThatIsSeenFromOneViewpoint) {
  Tracker tracker(parameters());
  for (int i = 0; i < 10; ++i) {
    (void)tracker.update(view_from(0.1 + 0.1 * i, 0.0), Observations{seen_at(0.5, 0.0)});
  }
  ASSERT_EQ(tracker.tracks().size(), 1U);
  EXPECT_FALSE(tracker.tracks()[0].confirmed);
  (void)tracker.update(view_from(2.0, 0.003), Observations{seen_at(0.5, 0.0)});
  EXPECT_TRUE(tracker.tracks()[0].confirmed);
}

TEST(RepeatedView, TurningIsMotion) {
  Tracker tracker = with_a_plant();
  EXPECT_TRUE(tracker.update(view_from(0.3, 0.1, 0.001), {}).repeated_view);
  EXPECT_FALSE(tracker.update(view_from(0.4, 0.1, 0.003), {}).repeated_view);
}

// GNSS may move the pose of a robot that stands; that is no motion.
TEST(RepeatedView, ACorrectionOfThePoseIsNotMotion) {
  Tracker tracker = with_a_plant();
  View corrected = view_from(0.3, 0.15);
  corrected.correction = {0.05, 0.0, 0.0};
  EXPECT_TRUE(tracker.update(corrected, Observations{seen_at(0.55, 0.0)}).repeated_view);
  EXPECT_NEAR(tracker.tracks()[0].p_F_m.x(), 0.55, 1e-12);
}

TEST(RepeatedView, CreepingIsMotionOnceItAddsUp) {
  Tracker tracker = with_a_plant();
  EXPECT_TRUE(tracker.update(view_from(0.3, 0.1015), {}).repeated_view);
  EXPECT_FALSE(tracker.update(view_from(0.4, 0.1025), {}).repeated_view);
}

}  // namespace
}  // namespace furrow::tracking
