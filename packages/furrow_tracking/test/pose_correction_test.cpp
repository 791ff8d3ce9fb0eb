#include "furrow_tracking/pose_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {
namespace {

using geometry::Pose2;

Time at(double seconds) {
  return Time{} + Duration::seconds(seconds);
}

/// A quarter of a circle of 2 m radius at 0.5 m/s, from the origin on.
Pose2 on_arc(double seconds) {
  constexpr double kRadius_m = 2.0;
  const double turn_rad = 0.25 * seconds;
  return {kRadius_m * std::sin(turn_rad), kRadius_m * (1.0 - std::cos(turn_rad)), turn_rad};
}

TEST(PoseCorrection, DrivingIsNone) {
  PoseCorrection correction;
  for (int i = 0; i <= 600; ++i) {
    const double t_s = 0.01 * i;
    ASSERT_TRUE(correction.add(at(t_s), on_arc(t_s), 0.5, 0.25).ok());
  }
  EXPECT_NEAR(correction.pending().x_m, 0.0, 1e-4);
  EXPECT_NEAR(correction.pending().y_m, 0.0, 1e-4);
  EXPECT_NEAR(correction.pending().heading_rad, 0.0, 1e-9);
}

TEST(PoseCorrection, PlantsKeepTheirPlaceAgainstTheRobotThroughJumps) {
  // Poses in a frame that is moved twice; the robot itself drives on along its arc.
  const Pose2 first_jump{0.2, -0.1, 0.05};
  const Pose2 second_jump{-0.03, 0.02, -0.01};
  PoseCorrection correction;
  const Eigen::Vector2d plant(1.5, 0.4);
  Pose2 X_FB;
  Pose2 moved;
  for (int i = 0; i <= 400; ++i) {
    const double t_s = 0.01 * i;
    if (i == 100) moved = first_jump;
    if (i == 250) moved = geometry::compose(second_jump, moved);
    X_FB = geometry::compose(moved, on_arc(t_s));
    ASSERT_TRUE(correction.add(at(t_s), X_FB, 0.5, 0.25).ok());
  }
  const Eigen::Vector2d p_B = geometry::transform(geometry::inverse(on_arc(4.0)), plant);
  const Eigen::Vector2d brought = geometry::transform(correction.pending(), plant);
  const Eigen::Vector2d brought_B = geometry::transform(geometry::inverse(X_FB), brought);
  EXPECT_NEAR((brought_B - p_B).norm(), 0.0, 1e-4);
  correction.clear();
  EXPECT_EQ(correction.pending().x_m, 0.0);
}

TEST(PoseCorrection, AGapIsNotACorrection) {
  PoseCorrection correction(Duration::seconds(0.5));
  ASSERT_TRUE(correction.add(at(0.0), {0.0, 0.0, 0.0}, 0.5, 0.0).ok());
  ASSERT_TRUE(correction.add(at(2.0), {1.7, 0.0, 0.0}, 0.5, 0.0).ok());
  EXPECT_EQ(correction.pending().x_m, 0.0);
  ASSERT_TRUE(correction.add(at(2.1), {1.76, 0.0, 0.0}, 0.5, 0.0).ok());
  EXPECT_NEAR(correction.pending().x_m, 0.01, 1e-12);
}

TEST(PoseCorrection, RefusesWhatIsNotFiniteOrNotNewer) {
  PoseCorrection correction;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(correction.add(at(1.0), {}, 0.5, 0.0).ok());
  EXPECT_EQ(correction.add(at(1.1), {nan, 0.0, 0.0}, 0.5, 0.0).error().code,
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(correction.add(at(1.1), {}, 0.5, nan).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(correction.add(at(1.0), {}, 0.5, 0.0).error().code, ErrorCode::kStale);
  EXPECT_EQ(correction.pending().x_m, 0.0);
}

TEST(TrackerFollowsThePose, UntilTheRobotHasPassed) {
  TrackerParameters parameters;
  parameters.confirm_matches = 1;
  parameters.follow_behind_m = 0.5;
  Tracker tracker(parameters);
  std::vector<Observation> plants(2);
  plants[0].p_F_m = {-0.6, 0.1};
  plants[1].p_F_m = {0.8, 0.2};
  (void)tracker.update({.stamp = at(0.0)}, plants);
  ASSERT_EQ(tracker.tracks().size(), 2U);
  (void)tracker.update({.stamp = at(0.1), .correction = {0.03, -0.01, 0.0}}, {});
  for (const Track& track : tracker.tracks()) {
    const bool ahead = track.p_F_m.x() > 0.0;
    EXPECT_NEAR(track.p_F_m.x(), ahead ? 0.83 : -0.6, 1e-12);
    EXPECT_NEAR(track.p_F_m.y(), ahead ? 0.19 : 0.1, 1e-12);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(tracker.update({.stamp = at(0.2), .correction = {nan, 0.0, 0.0}}, {}).fault,
            ViewFault::kBadPose);
}

}  // namespace
}  // namespace furrow::tracking
