#include "furrow_localization/odometry_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "furrow_core/error.hpp"
#include "simulated_drive.hpp"

namespace furrow::localization {
namespace {

WheelOdometry wheels_at(double t_s, double speed_mps, double yaw_rate_radps) {
  WheelOdometry m;
  m.stamp = Time::from_seconds(t_s);
  m.speed_mps = speed_mps;
  m.yaw_rate_radps = yaw_rate_radps;
  return m;
}

TEST(OdometryIntegrator, AFullCircleEndsWhereItBegan) {
  OdometryIntegrator integrator;
  const double yaw_rate = 2.0 * std::numbers::pi / 10.0;
  for (int i = 0; i <= 100; ++i) {
    EXPECT_EQ(integrator.add(wheels_at(0.1 * i, 0.5, yaw_rate)), Outcome::kUsed);
  }
  const PoseEstimate end = *integrator.predict(Time::from_seconds(10.0));
  EXPECT_NEAR(end.X_FB.x_m, 0.0, 1e-9);
  EXPECT_NEAR(end.X_FB.y_m, 0.0, 1e-9);
  EXPECT_NEAR(end.X_FB.heading_rad, 0.0, 1e-9);
}

TEST(OdometryIntegrator, VarianceOfAStraightDriveIsTheSumOfItsSteps) {
  OdometryIntegrator integrator;
  for (int i = 0; i <= 50; ++i) integrator.add(wheels_at(0.02 * i, 1.0, 0.0));
  const Eigen::Matrix3d P = integrator.predict(Time::from_seconds(1.0))->covariance;
  EXPECT_NEAR(P(0, 0), 50 * 1e-4 * 0.02 * 0.02, 1e-12);
  EXPECT_NEAR(P(2, 2), 50 * 4e-4 * 0.02 * 0.02, 1e-12);
  // A heading error made in step i shifts y by the distance still to go, half of its own step.
  double across = 0.0;
  for (int i = 0; i < 50; ++i) {
    across += std::pow((49.5 - i) * 0.02, 2) * 4e-4 * 0.02 * 0.02;
  }
  EXPECT_NEAR(P(1, 1), across, 1e-10);
}

TEST(OdometryIntegrator, PredictsBetweenAndBeyondMeasurements) {
  OdometryIntegrator integrator;
  integrator.add(wheels_at(0.0, 1.0, 0.0));
  integrator.add(wheels_at(0.1, 2.0, 0.0));
  EXPECT_NEAR(integrator.predict(Time::from_seconds(0.1))->X_FB.x_m, 0.15, 1e-12);
  EXPECT_NEAR(integrator.predict(Time::from_seconds(0.05))->X_FB.x_m, 0.075, 1e-12);
  EXPECT_NEAR(integrator.predict(Time::from_seconds(0.05))->speed_mps, 1.5, 1e-12);
  EXPECT_NEAR(integrator.predict(Time::from_seconds(0.2))->X_FB.x_m, 0.35, 1e-12);
  EXPECT_EQ(integrator.predict(Time::from_seconds(0.7)).error().code, ErrorCode::kStale);
  EXPECT_EQ(integrator.predict(Time::from_seconds(-0.1)).error().code, ErrorCode::kStale);
}

TEST(OdometryIntegrator, DoesNotDriveAcrossAGap) {
  OdometryIntegrator integrator;
  integrator.add(wheels_at(0.0, 1.0, 0.0));
  integrator.add(wheels_at(0.5, 1.0, 0.0));
  integrator.add(wheels_at(10.0, 1.0, 0.0));
  EXPECT_NEAR(integrator.predict(Time::from_seconds(10.1))->X_FB.x_m, 0.5 + 0.1, 1e-12);
}

TEST(OdometryIntegrator, CountsWhatItRefuses) {
  OdometryIntegrator integrator;
  EXPECT_EQ(integrator.predict(Time()).error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(integrator.health(Time()).level, HealthLevel::kLost);
  EXPECT_EQ(integrator.add(wheels_at(1.0, 0.5, 0.0)), Outcome::kUsed);
  EXPECT_EQ(integrator.add(wheels_at(0.9, 0.5, 0.0)), Outcome::kTooOld);
  EXPECT_EQ(integrator.add(wheels_at(1.0, 0.5, 0.0)), Outcome::kDuplicate);
  EXPECT_EQ(integrator.add(wheels_at(1.1, std::numeric_limits<double>::quiet_NaN(), 0.0)),
            Outcome::kInvalid);
  WheelOdometry no_variance = wheels_at(1.1, 0.5, 0.0);
  no_variance.yaw_rate_variance = 0.0;
  EXPECT_EQ(integrator.add(no_variance), Outcome::kInvalid);
  EXPECT_EQ(integrator.add(ImuYawRate{}), Outcome::kIgnored);
  EXPECT_EQ(integrator.add(GnssPosition{}), Outcome::kIgnored);
  const LocalizationHealth health = integrator.health(Time::from_seconds(1.1));
  EXPECT_EQ(health.odometry.used, 1);
  EXPECT_EQ(health.odometry.too_old, 1);
  EXPECT_EQ(health.odometry.duplicate, 1);
  EXPECT_EQ(health.odometry.invalid, 2);
  EXPECT_EQ(health.gnss.ignored, 1);
  EXPECT_EQ(health.level, HealthLevel::kOk);
  EXPECT_EQ(integrator.health(Time::from_seconds(1.4)).level, HealthLevel::kDegraded);
  EXPECT_EQ(integrator.health(Time::from_seconds(2.0)).level, HealthLevel::kLost);
}

TEST(OdometryIntegrator, StartsFromAResetPose) {
  OdometryIntegrator integrator;
  const double quarter = 0.5 * std::numbers::pi;
  ASSERT_TRUE(integrator.reset(Time(), {1.0, 2.0, quarter}, Eigen::Matrix3d::Zero()).ok());
  integrator.add(wheels_at(0.5, 1.0, 0.0));
  const PoseEstimate estimate = *integrator.predict(Time::from_seconds(0.5));
  EXPECT_NEAR(estimate.X_FB.x_m, 1.0, 1e-12);
  EXPECT_NEAR(estimate.X_FB.y_m, 2.5, 1e-12);
  EXPECT_FALSE(integrator.reset(Time(), {}, -Eigen::Matrix3d::Identity()).ok());
}

TEST(OdometryIntegrator, DriftsWhereTheFilterDoesNot) {
  const test::DriveOptions options;
  const test::Drive drive = test::simulate_drive(4, options);
  OdometryIntegrator integrator;
  PoseFilter filter(test::parameters_for(options));
  for (const auto& measurement : drive.measurements) {
    test::add(integrator, measurement);
    test::add(filter, measurement);
  }
  const Time end = drive.truth.back().stamp;
  const geometry::Pose2& truth = drive.truth.back().X_FB;
  const auto error_m = [&](const geometry::Pose2& X_FB) {
    return std::hypot(X_FB.x_m - truth.x_m, X_FB.y_m - truth.y_m);
  };
  EXPECT_LT(error_m(filter.predict(end)->X_FB), 0.02);
  EXPECT_GT(error_m(integrator.predict(end)->X_FB), 0.10);
}

}  // namespace
}  // namespace furrow::localization
