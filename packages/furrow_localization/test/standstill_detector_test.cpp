#include "furrow_localization/standstill_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"

namespace furrow::localization {
namespace {

constexpr double kStep_s = 0.01;

/// Wheels and gyroscope at 100 Hz, with the noise of the RTK graph's sensors.
class Sensors {
 public:
  explicit Sensors(std::uint64_t seed, double noise = 1.0)
      : random_(seed, "still"), noise_(noise) {}

  void run(StandstillDetector& detector, double seconds,
           const std::function<double(double)>& speed_mps, double yaw_rate_radps = 0.0) {
    const double end_s = now_s_ + seconds;
    for (; now_s_ < end_s - kStep_s / 2; now_s_ += kStep_s) {
      const Time now = Time::from_seconds(now_s_);
      detector.add_wheels(now, speed_mps(now_s_) + noise_ * 0.01 * random_.normal(0.0, 1.0),
                          yaw_rate_radps + noise_ * 0.02 * random_.normal(0.0, 1.0));
      detector.add_gyroscope(now,
                             yaw_rate_radps + 0.001 + noise_ * 0.003 * random_.normal(0.0, 1.0));
    }
  }
  [[nodiscard]] double now_s() const { return now_s_; }

 private:
  Random random_;
  double noise_;
  double now_s_ = 1.0;
};

double still(double) {
  return 0.0;
}

TEST(StandstillDetector, FindsARobotThatStandsWithinASecond) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    StandstillDetector detector;
    Sensors sensors(seed);
    sensors.run(detector, 1.0, [](double) { return 0.5; });
    EXPECT_FALSE(detector.standing());
    sensors.run(detector, 1.0, still);
    EXPECT_TRUE(detector.standing()) << seed;
  }
}

TEST(StandstillDetector, DrivingOnEndsItWithinATenthOfASecond) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    StandstillDetector detector;
    Sensors sensors(seed);
    sensors.run(detector, 1.0, still);
    const double from_s = sensors.now_s();
    sensors.run(detector, 0.1, [&](double t_s) { return 0.5 * (t_s - from_s); });
    EXPECT_FALSE(detector.standing()) << seed;
  }
}

TEST(StandstillDetector, SlowDrivingAndTurningOnTheSpotAreMotion) {
  StandstillDetector detector;
  Sensors sensors(3);
  for (const double speed_mps : {0.02, -0.02, 0.05}) {
    sensors.run(detector, 5.0, [&](double) { return speed_mps; });
    EXPECT_FALSE(detector.standing()) << speed_mps;
  }
  sensors.run(detector, 5.0, still, 0.1);
  EXPECT_FALSE(detector.standing());
}

TEST(StandstillDetector, RockingToAndFroIsMotion) {
  StandstillDetector detector;
  Sensors sensors(4);
  for (int i = 0; i < 20; ++i) {
    sensors.run(detector, 0.25, [](double t_s) { return 0.2 * std::sin(40.0 * t_s); });
    EXPECT_FALSE(detector.standing());
  }
}

TEST(StandstillDetector, CreepingEndsIt) {
  StandstillDetector detector;
  Sensors sensors(5, 0.0);
  sensors.run(detector, 1.0, [](double) { return 0.004; });
  EXPECT_TRUE(detector.standing());
  int released = 0;
  for (int i = 0; i < 100; ++i) {
    sensors.run(detector, 0.1, [](double) { return 0.004; });
    released += detector.standing() ? 0 : 1;
  }
  EXPECT_GT(released, 0);  // each 7.5 s at 4 mm/s are 3 cm
}

TEST(StandstillDetector, RefusesParametersOutOfRange) {
  EXPECT_THROW(StandstillDetector({.window_s = 0.0}), ConfigError);
}

}  // namespace
}  // namespace furrow::localization
