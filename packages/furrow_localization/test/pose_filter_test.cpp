#include "furrow_localization/pose_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "furrow_core/error.hpp"
#include "simulated_drive.hpp"

namespace furrow::localization {
namespace {

using namespace test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void feed(PoseFilter& filter, const std::vector<AnyMeasurement>& measurements) {
  for (const AnyMeasurement& measurement : measurements) add(filter, measurement);
}

TEST(PoseFilter, SaysThatItKnowsNothingBeforeTheFirstMeasurement) {
  const PoseFilter filter;
  ASSERT_FALSE(filter.predict(Time()).ok());
  EXPECT_EQ(filter.predict(Time()).error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(filter.health(Time()).level, HealthLevel::kLost);
}

TEST(PoseFilter, LateMeasurementsGiveTheEstimateOfTheOrderedSequenceToTheBit) {
  DriveOptions options;
  options.duration_s = 5.0;
  const Drive drive = simulate_drive(11, options);
  PoseFilter ordered(parameters_for(options));
  feed(ordered, drive.measurements);

  Random random(12);
  std::vector<std::pair<double, AnyMeasurement>> arrivals;
  for (const AnyMeasurement& measurement : drive.measurements) {
    const bool first = stamp_of(measurement) == Time();
    arrivals.emplace_back(
        stamp_of(measurement).to_seconds() + (first ? 0.0 : random.uniform(0.0, 0.4)), measurement);
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  PoseFilter shuffled(parameters_for(options));
  for (const auto& [arrival_s, measurement] : arrivals) {
    const Outcome outcome = add(shuffled, measurement);
    EXPECT_TRUE(outcome == Outcome::kUsed || outcome == Outcome::kUsedLate ||
                outcome == Outcome::kGated);
  }
  EXPECT_GT(shuffled.health(Time()).gnss.late, 10);
  const Time end = stamp_of(drive.measurements.back());
  const PoseEstimate a = *ordered.predict(end);
  const PoseEstimate b = *shuffled.predict(end);
  EXPECT_EQ(a.X_FB.x_m, b.X_FB.x_m);
  EXPECT_EQ(a.X_FB.y_m, b.X_FB.y_m);
  EXPECT_EQ(a.X_FB.heading_rad, b.X_FB.heading_rad);
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST(PoseFilter, KeepsASingleJumpOutAndFollowsALastingOne) {
  const DriveOptions options;
  const Drive drive = simulate_drive(5, options);
  PoseFilter filter(parameters_for(options));
  int gated = 0;
  int recovered = 0;
  for (const AnyMeasurement& measurement : drive.measurements) {
    const double t = stamp_of(measurement).to_seconds();
    AnyMeasurement reported = measurement;
    if (auto* fix = std::get_if<GnssPosition>(&reported)) {
      if (t == 20.0) fix->p_FA_m.y() += 0.5;  // one bad fix
      if (t >= 40.0) fix->p_FA_m.x() += 0.3;  // the base station has moved
    }
    const Outcome outcome = add(filter, reported);
    if (!std::holds_alternative<GnssPosition>(reported)) continue;
    if (t == 20.0) {
      EXPECT_EQ(outcome, Outcome::kGated);
      EXPECT_NEAR(filter.predict(stamp_of(measurement))->X_FB.y_m, drive.truth[2000].X_FB.y_m,
                  0.02);
    }
    if (t >= 40.0 && t < 42.0) {
      gated += outcome == Outcome::kGated ? 1 : 0;
      recovered += outcome == Outcome::kRecovered ? 1 : 0;
    }
  }
  EXPECT_EQ(gated, 9);  // the tenth in a row that agrees moves the state
  EXPECT_EQ(recovered, 1);
  EXPECT_NEAR(filter.predict(Time::from_seconds(60.0))->X_FB.x_m, drive.truth[6000].X_FB.x_m + 0.3,
              0.02);
}

TEST(PoseFilter, ScatteredOutliersNeverMoveTheState) {
  const DriveOptions options;
  const Drive drive = simulate_drive(6, options);
  PoseFilter filter(parameters_for(options));
  Random random(7);
  for (const AnyMeasurement& measurement : drive.measurements) {
    AnyMeasurement reported = measurement;
    const double t = stamp_of(measurement).to_seconds();
    auto* fix = std::get_if<GnssPosition>(&reported);
    if (fix != nullptr && t >= 30.0 && t < 35.0) {
      fix->p_FA_m += Eigen::Vector2d(random.uniform(0.5, 3.0), random.uniform(0.5, 3.0));
      EXPECT_EQ(add(filter, reported), Outcome::kGated);
    } else {
      add(filter, reported);
    }
  }
  const PoseEstimate estimate = *filter.predict(Time::from_seconds(60.0));
  EXPECT_NEAR(estimate.X_FB.x_m, drive.truth[6000].X_FB.x_m, 0.02);
  EXPECT_EQ(filter.health(Time::from_seconds(60.0)).gnss.recovered, 0);
}

TEST(PoseFilter, FixQualityDecidesTheWeight) {
  const auto shift_after_fix = [](FixQuality quality) {
    PoseFilterParameters parameters;
    PoseFilter filter(parameters);
    EXPECT_TRUE(filter.reset(Time(), {}, Eigen::Matrix3d::Identity() * 0.01).ok());
    GnssPosition fix;
    fix.stamp = Time();
    fix.p_FA_m = {0.1, 0.0};
    fix.quality = quality;
    filter.add(fix);
    return filter.predict(Time())->X_FB.x_m;
  };
  // Gain P / (P + R) with P = 0.01 m2 and R the square of each quality's sigma.
  EXPECT_NEAR(shift_after_fix(FixQuality::kRtkFixed), 0.1 * 0.01 / (0.01 + 1e-4), 1e-9);
  EXPECT_NEAR(shift_after_fix(FixQuality::kRtkFloat), 0.1 * 0.01 / (0.01 + 0.0225), 1e-9);
  EXPECT_NEAR(shift_after_fix(FixQuality::kDifferential), 0.1 * 0.01 / (0.01 + 0.25), 1e-9);
  EXPECT_NEAR(shift_after_fix(FixQuality::kSingle), 0.1 * 0.01 / (0.01 + 4.0), 1e-9);
  EXPECT_EQ(shift_after_fix(FixQuality::kNone), 0.0);
}

TEST(PoseFilter, TheAntennasLeverArmIsTakenOff) {
  PoseFilterParameters parameters;
  parameters.antenna_x_m = 0.5;
  parameters.antenna_y_m = -0.2;
  PoseFilter filter(parameters);
  const double heading_rad = 0.7;
  ASSERT_TRUE(
      filter.reset(Time(), {1.0, 2.0, heading_rad}, Eigen::Vector3d(1.0, 1.0, 1e-12).asDiagonal())
          .ok());
  GnssPosition fix;
  fix.stamp = Time();
  fix.p_FA_m = geometry::transform({1.3, 2.4, heading_rad}, {0.5, -0.2});
  EXPECT_EQ(filter.add(fix), Outcome::kUsed);
  EXPECT_NEAR(filter.predict(Time())->X_FB.x_m, 1.3, 1e-4);
  EXPECT_NEAR(filter.predict(Time())->X_FB.y_m, 2.4, 1e-4);
}

TEST(PoseFilter, PredictsAlongAnArc) {
  PoseFilter filter;
  ASSERT_TRUE(filter.reset(Time(), {}, Eigen::Matrix3d::Identity() * 1e-6).ok());
  WheelOdometry wheels;
  wheels.speed_mps = 1.0;
  wheels.yaw_rate_radps = 0.5;
  wheels.speed_variance = 1e-10;
  wheels.yaw_rate_variance = 1e-10;
  wheels.stamp = Time();
  EXPECT_EQ(filter.add(wheels), Outcome::kUsed);
  // What the wheels say is shared between motion, scale and curvature by their prior variances, so
  // the arc is that of the speeds the filter holds.
  const PoseEstimate now = *filter.predict(Time());
  const double turn = now.yaw_rate_radps * 0.4;
  const PoseEstimate later = *filter.predict(Time::from_seconds(0.4));
  const double radius_m = now.speed_mps / now.yaw_rate_radps;
  EXPECT_NEAR(later.X_FB.x_m, radius_m * std::sin(turn), 1e-4);
  EXPECT_NEAR(later.X_FB.y_m, radius_m * (1.0 - std::cos(turn)), 1e-4);
  EXPECT_NEAR(later.X_FB.heading_rad, turn, 1e-9);
  EXPECT_GT(later.covariance(0, 0), now.covariance(0, 0));
}

TEST(PoseFilter, CovarianceStaysPositiveThroughOutagesAndJumps) {
  const DriveOptions options;
  const Drive drive = simulate_drive(8, options);
  PoseFilter filter(parameters_for(options));
  Random random(9);
  for (const AnyMeasurement& measurement : drive.measurements) {
    if (random.bernoulli(0.3)) continue;
    AnyMeasurement reported = measurement;
    if (auto* fix = std::get_if<GnssPosition>(&reported); fix != nullptr && random.bernoulli(0.1)) {
      fix->p_FA_m.x() += random.normal(0.0, 1.0);
    }
    add(filter, reported);
    const PoseEstimate estimate = *filter.predict(stamp_of(reported));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(estimate.covariance);
    ASSERT_GT(solver.eigenvalues()(0), 0.0);
  }
}

TEST(PoseFilter, CountsAndRefusesWhatIsNotValid) {
  PoseFilter filter;
  WheelOdometry wheels;
  wheels.speed_mps = 0.5;
  ASSERT_EQ(filter.add(wheels), Outcome::kUsed);
  const geometry::Pose2 before = filter.predict(Time())->X_FB;
  for (const double bad : {kNan, kInfinity, 1e6}) {
    WheelOdometry m = wheels;
    m.stamp = Time::from_seconds(0.1);
    m.speed_mps = bad;
    EXPECT_EQ(filter.add(m), Outcome::kInvalid);
    m = wheels;
    m.yaw_rate_radps = bad;
    EXPECT_EQ(filter.add(m), Outcome::kInvalid);
    ImuYawRate imu;
    imu.yaw_rate_radps = bad;
    EXPECT_EQ(filter.add(imu), Outcome::kInvalid);
    GnssPosition fix;
    fix.p_FA_m.x() = bad == 1e6 ? 1e9 : bad;
    EXPECT_EQ(filter.add(fix), Outcome::kInvalid);
  }
  for (const double bad : {kNan, kInfinity, 0.0, -1.0}) {
    WheelOdometry m = wheels;
    m.speed_variance = bad;
    EXPECT_EQ(filter.add(m), Outcome::kInvalid);
    ImuYawRate imu;
    imu.yaw_rate_variance = bad;
    EXPECT_EQ(filter.add(imu), Outcome::kInvalid);
    GnssPosition fix;
    fix.covariance = Eigen::Matrix2d::Identity() * bad;
    EXPECT_EQ(filter.add(fix), Outcome::kInvalid);
  }
  GnssPosition skewed;
  skewed.covariance = (Eigen::Matrix2d() << 1.0, 2.0, 2.0, 1.0).finished();  // eigenvalue -1
  EXPECT_EQ(filter.add(skewed), Outcome::kInvalid);
  skewed.covariance = (Eigen::Matrix2d() << 1.0, 0.5, 0.0, 1.0).finished();
  EXPECT_EQ(filter.add(skewed), Outcome::kInvalid);

  const LocalizationHealth health = filter.health(Time());
  EXPECT_EQ(health.odometry.invalid, 3 + 3 + 4);
  EXPECT_EQ(health.imu.invalid, 3 + 4);
  EXPECT_EQ(health.gnss.invalid, 3 + 4 + 2);
  EXPECT_EQ(filter.predict(Time())->X_FB.x_m, before.x_m);
}

TEST(PoseFilter, RefusesRepeatedOldAndFarFutureMeasurements) {
  PoseFilterParameters parameters;
  parameters.history_s = 0.5;
  PoseFilter filter(parameters);
  WheelOdometry wheels;
  wheels.speed_mps = 0.5;
  for (int i = 0; i <= 100; ++i) {
    wheels.stamp = Time() + Duration::milliseconds(20) * i;
    ASSERT_NE(filter.add(wheels), Outcome::kInvalid);
  }
  EXPECT_EQ(filter.add(wheels), Outcome::kDuplicate);
  wheels.stamp = Time::from_seconds(1.0);
  EXPECT_EQ(filter.add(wheels), Outcome::kTooOld);
  EXPECT_EQ(filter.predict(Time::from_seconds(1.0)).error().code, ErrorCode::kStale);
  EXPECT_EQ(filter.predict(Time::from_seconds(2.6)).error().code, ErrorCode::kStale);
  EXPECT_TRUE(filter.predict(Time::from_seconds(2.4)).ok());
  EXPECT_TRUE(filter.predict(Time::from_seconds(1.7)).ok());

  // One stamp from a broken clock is refused; a clock that stays ahead is followed.
  wheels.stamp = Time::from_seconds(1000.0);
  EXPECT_EQ(filter.add(wheels), Outcome::kInvalid);
  wheels.stamp = Time::from_seconds(2.02);
  EXPECT_EQ(filter.add(wheels), Outcome::kUsed);
  int refused = 0;
  for (int i = 0; i < 20; ++i) {
    wheels.stamp = Time::from_seconds(1000.0) + Duration::milliseconds(20) * i;
    refused += filter.add(wheels) == Outcome::kInvalid ? 1 : 0;
  }
  EXPECT_EQ(refused, 9);
  EXPECT_TRUE(filter.predict(wheels.stamp).ok());
}

TEST(PoseFilter, ABoundedHistoryHoldsTheNewestMeasurements) {
  PoseFilterParameters parameters;
  parameters.history_measurements = 4;
  PoseFilter filter(parameters);
  WheelOdometry wheels;
  for (int i = 0; i <= 10; ++i) {
    wheels.stamp = Time() + Duration::milliseconds(20) * i;
    EXPECT_EQ(filter.add(wheels), Outcome::kUsed);
  }
  ImuYawRate imu;
  imu.stamp = Time() + Duration::milliseconds(130);
  EXPECT_EQ(filter.add(imu), Outcome::kTooOld);
  imu.stamp = Time() + Duration::milliseconds(150);
  EXPECT_EQ(filter.add(imu), Outcome::kUsedLate);
}

TEST(PoseFilter, FollowsWheelsThatStopAtOnce) {
  PoseFilter filter;
  WheelOdometry wheels;
  wheels.speed_mps = 2.0;
  for (int i = 0; i < 100; ++i) {
    wheels.stamp = Time() + Duration::milliseconds(20) * i;
    if (i == 50) wheels.speed_mps = 0.0;
    const Outcome outcome = filter.add(wheels);
    if (i < 50) continue;
    EXPECT_EQ(outcome, i < 52 ? Outcome::kGated : i == 52 ? Outcome::kRecovered : Outcome::kUsed);
  }
  EXPECT_NEAR(filter.predict(wheels.stamp)->speed_mps, 0.0, 0.02);
}

TEST(PoseFilter, HealthFollowsTheSensors) {
  DriveOptions options;
  options.duration_s = 10.0;
  const Drive drive = simulate_drive(2, options);
  PoseFilter filter(parameters_for(options));
  feed(filter, drive.measurements);
  const Time end = Time::from_seconds(10.0);
  EXPECT_EQ(filter.health(end).level, HealthLevel::kOk);
  EXPECT_EQ(filter.health(end).fix_quality, FixQuality::kRtkFixed);
  EXPECT_EQ(filter.health(end + Duration::milliseconds(300)).level, HealthLevel::kDegraded);
  EXPECT_EQ(filter.health(end + Duration::milliseconds(600)).level, HealthLevel::kLost);
  GnssPosition lost_fix;
  lost_fix.stamp = end + Duration::milliseconds(10);
  lost_fix.quality = FixQuality::kNone;
  EXPECT_EQ(filter.add(lost_fix), Outcome::kNoFix);
  EXPECT_EQ(filter.health(end).gnss.no_fix, 1);
}

TEST(PoseFilter, SensorsCanBeLeftOut) {
  PoseFilterParameters parameters;
  parameters.use_gnss = false;
  parameters.use_imu = false;
  PoseFilter filter(parameters);
  EXPECT_EQ(filter.add(GnssPosition{}), Outcome::kIgnored);
  EXPECT_EQ(filter.add(ImuYawRate{}), Outcome::kIgnored);
  EXPECT_EQ(filter.add(WheelOdometry{}), Outcome::kUsed);
}

TEST(PoseFilter, ResetChecksWhatItIsGiven) {
  PoseFilter filter;
  const Eigen::Matrix3d good = Eigen::Matrix3d::Identity();
  EXPECT_FALSE(filter.reset(Time(), {kNan, 0.0, 0.0}, good).ok());
  EXPECT_FALSE(filter.reset(Time(), {0.0, kInfinity, 0.0}, good).ok());
  EXPECT_FALSE(filter.reset(Time(), {}, -good).ok());
  EXPECT_FALSE(filter.reset(Time(), {}, good * kNan).ok());
  EXPECT_EQ(filter.predict(Time()).error().code, ErrorCode::kUnavailable);
  // A reset may go back in time: a run that begins again.
  ASSERT_TRUE(filter.reset(Time::from_seconds(100.0), {}, good).ok());
  ASSERT_TRUE(filter.reset(Time::from_seconds(1.0), {4.0, 5.0, 0.1}, good).ok());
  EXPECT_EQ(filter.predict(Time::from_seconds(1.0))->X_FB.x_m, 4.0);
}

TEST(PoseFilter, RefusesParametersOutOfRange) {
  PoseFilterParameters parameters;
  parameters.acceleration_sigma = -1.0;
  EXPECT_THROW(PoseFilter{parameters}, ConfigError);
  parameters = {};
  parameters.gate_probability = 1.0;
  EXPECT_THROW(PoseFilter{parameters}, ConfigError);
  parameters = {};
  parameters.initial_x_m = kNan;
  EXPECT_THROW(PoseFilter{parameters}, ConfigError);
}

}  // namespace
}  // namespace furrow::localization
