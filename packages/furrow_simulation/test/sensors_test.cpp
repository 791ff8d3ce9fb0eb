#include "furrow_simulation/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace furrow::simulation {
namespace {

RobotState driving() {
  RobotState state;
  state.time = Time::from_seconds(3.0);
  state.X_FB = {2.0, -0.5, std::numbers::pi / 2};
  state.speed_mps = 0.45;
  state.wheel_speed_mps = 0.5;
  state.yaw_rate_radps = 0.2;
  state.acceleration_mps2 = 0.3;
  return state;
}

RobotState at(double t_s) {
  RobotState state;
  state.time = Time::from_seconds(t_s);
  return state;
}

TEST(Sensors, AreExactWithDefaultParameters) {
  const RobotState state = driving();
  const WheelReading wheels = WheelOdometry({}, 1).measure(state);
  EXPECT_EQ(wheels.speed_mps, 0.5);
  EXPECT_EQ(wheels.yaw_rate_radps, 0.2);
  EXPECT_EQ(wheels.time, state.time);
  const ImuReading imu = Imu({}, 1).measure(state);
  EXPECT_EQ(imu.angular_velocity_B_radps, Eigen::Vector3d(0.0, 0.0, 0.2));
  EXPECT_NEAR(imu.acceleration_B_mps2.x(), 0.3, 1e-15);
  EXPECT_NEAR(imu.acceleration_B_mps2.y(), 0.45 * 0.2, 1e-15);  // v^2 / r towards the centre
  EXPECT_NEAR(imu.acceleration_B_mps2.z(), 9.80665, 1e-15);
  GnssParameters mounted;
  mounted.antenna_x_m = 0.4;
  mounted.antenna_y_m = 0.1;
  mounted.latency_s = 0.08;
  const auto gnss = Gnss(mounted, 1).measure(state);
  ASSERT_TRUE(gnss.has_value());
  // Turned left by a right angle: forward is +y, left is -x.
  EXPECT_NEAR(gnss->p_F_m.x(), 2.0 - 0.1, 1e-12);
  EXPECT_NEAR(gnss->p_F_m.y(), -0.5 + 0.4, 1e-12);
  EXPECT_EQ(gnss->quality, GnssQuality::kFixed);
  EXPECT_EQ(gnss->available, Time::from_seconds(3.08));
}

TEST(WheelOdometry, ScalesBiasesAndScatters) {
  WheelOdometryParameters parameters{.speed_scale = 1.02,
                                     .speed_noise_mps = 0.01,
                                     .yaw_rate_scale = 0.9,
                                     .yaw_rate_noise_radps = 0.005,
                                     .yaw_rate_bias_radps = 0.01};
  WheelOdometry odometry(parameters, 4);
  double speed = 0.0;
  double speed_squares = 0.0;
  double yaw = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const WheelReading reading = odometry.measure(driving());
    speed += reading.speed_mps - 0.51;
    speed_squares += std::pow(reading.speed_mps - 0.51, 2);
    yaw += reading.yaw_rate_radps - 0.19;
  }
  EXPECT_NEAR(speed / n, 0.0, 5 * 0.01 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(speed_squares / n), 0.01, 0.0003);
  EXPECT_NEAR(yaw / n, 0.0, 5 * 0.005 / std::sqrt(n));
}

TEST(Imu, BiasWalksWithTheRootOfTime) {
  ImuParameters parameters;
  parameters.gyro_bias_radps = 0.01;
  parameters.gyro_bias_walk_radps_per_sqrt_s = 0.002;
  double squares = 0.0;
  const int runs = 2000;
  for (int seed = 0; seed < runs; ++seed) {
    Imu imu(parameters, static_cast<std::uint64_t>(seed));
    for (int i = 0; i <= 50; ++i) (void)imu.measure(at(i * 0.5));
    squares += std::pow(imu.gyro_bias_radps() - 0.01, 2);
  }
  // 25 s: 0.002 * 5; the deviation of an estimate from n samples is 1 / sqrt(2 n) of it.
  EXPECT_NEAR(std::sqrt(squares / runs), 0.01, 0.01 * 5 / std::sqrt(2.0 * runs));
}

TEST(Imu, FirstReadingHasTheInitialBias) {
  ImuParameters parameters;
  parameters.gyro_bias_radps = -0.03;
  parameters.gyro_bias_walk_radps_per_sqrt_s = 1.0;
  EXPECT_EQ(Imu(parameters, 1).measure(at(1000.0)).angular_velocity_B_radps.z(), -0.03);
}

TEST(Sensors, RepeatWithTheirSeedAndDifferWithAnother) {
  GnssParameters parameters;
  parameters.fixed_noise_m = 0.01;
  parameters.jumps_per_min = 20.0;
  parameters.outages_per_min = 20.0;
  const auto readings = [&](std::uint64_t seed) {
    Gnss gnss(parameters, seed);
    std::vector<double> values;
    for (int i = 0; i < 200; ++i) {
      const auto reading = gnss.measure(at(i * 0.1));
      values.push_back(reading ? reading->p_F_m.x() : -99.0);
    }
    return values;
  };
  EXPECT_EQ(readings(1), readings(1));
  EXPECT_NE(readings(1), readings(2));
}

TEST(Gnss, OutagesTakeTheirShareOfTheTime) {
  GnssParameters parameters;
  parameters.outages_per_min = 6.0;  // 10 s apart, 5 s long: a third of the time
  parameters.outage_mean_s = 5.0;
  Gnss gnss(parameters, 3);
  int lost = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) lost += gnss.measure(at(i * 0.2)).has_value() ? 0 : 1;
  EXPECT_NEAR(static_cast<double>(lost) / n, 1.0 / 3.0, 0.03);
}

TEST(Gnss, ALostFixComesBackByWayOfFloat) {
  GnssParameters parameters;
  parameters.fixed_noise_m = 0.01;
  parameters.float_noise_m = 0.2;
  parameters.single_noise_m = 1.5;
  parameters.degraded_per_min = 3.0;
  Gnss gnss(parameters, 9);
  GnssQuality last = GnssQuality::kFixed;
  std::set<GnssQuality> seen;
  for (int i = 0; i < 60000; ++i) {
    const auto reading = gnss.measure(at(i * 0.01));
    ASSERT_TRUE(reading.has_value());
    const double claimed_m = reading->quality == GnssQuality::kFixed   ? 0.01
                             : reading->quality == GnssQuality::kFloat ? 0.2
                                                                       : 1.5;
    EXPECT_EQ(reading->standard_deviation_m, claimed_m);
    EXPECT_LT(reading->p_F_m.norm(), 7 * claimed_m);
    EXPECT_FALSE(last == GnssQuality::kSingle && reading->quality == GnssQuality::kFixed);
    EXPECT_FALSE(last == GnssQuality::kFloat && reading->quality == GnssQuality::kSingle);
    last = reading->quality;
    seen.insert(last);
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(Gnss, AWrongFixIsDisplacedButReportedAsFixed) {
  GnssParameters parameters;
  parameters.jumps_per_min = 6.0;
  parameters.jump_m = 0.3;
  Gnss gnss(parameters, 2);
  std::set<std::pair<double, double>> places;
  int displaced = 0;
  for (int i = 0; i < 6000; ++i) {
    const auto reading = gnss.measure(at(i * 0.1));
    ASSERT_TRUE(reading.has_value());
    EXPECT_EQ(reading->quality, GnssQuality::kFixed);
    if (reading->p_F_m.norm() == 0.0) continue;
    EXPECT_NEAR(reading->p_F_m.norm(), 0.3, 1e-12);
    ++displaced;
    places.emplace(reading->p_F_m.x(), reading->p_F_m.y());
  }
  EXPECT_GT(places.size(), 10u);
  EXPECT_GT(displaced, 3 * static_cast<int>(places.size()));  // it stays while it lasts
}

}  // namespace
}  // namespace furrow::simulation
