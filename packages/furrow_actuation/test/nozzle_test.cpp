#include "furrow_actuation/nozzle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

Time at_ms(double ms) {
  return Time::from_seconds(ms * 1e-3);
}

TEST(ValveWindow, CentresTheDropletsOnTheEmission) {
  NozzleCalibration calibration;
  calibration.open_delay_s = 0.006;
  calibration.close_delay_s = 0.003;
  const ValveWindow window = valve_window(at_ms(1000), 0.020, calibration);
  EXPECT_EQ(window.open_command, at_ms(1000 - 10 - 6));
  EXPECT_EQ(window.close_command, at_ms(1000 + 10 - 3));
  calibration.close_delay_s = 0.5;
  const ValveWindow squeezed = valve_window(at_ms(1000), 0.020, calibration);
  EXPECT_GT(squeezed.close_command, squeezed.open_command);
}

TEST(SimulatedValve, FollowsItsCommandsAfterTheDelays) {
  SimulatedValve valve({0.005, 0.002, 0.0}, 1, "valve");
  ASSERT_TRUE(valve.write(at_ms(10), true).ok());
  ASSERT_TRUE(valve.write(at_ms(12), true).ok());
  ASSERT_TRUE(valve.write(at_ms(30), false).ok());
  EXPECT_TRUE(valve.take_changes(at_ms(14.9)).empty());
  const auto opened = valve.take_changes(at_ms(15));
  ASSERT_EQ(opened.size(), 1u);
  EXPECT_EQ(opened[0].time, at_ms(15));
  EXPECT_TRUE(valve.flowing());
  const auto closed = valve.take_changes(at_ms(100));
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_EQ(closed[0].time, at_ms(32));
  EXPECT_FALSE(closed[0].flowing);
}

TEST(SimulatedValve, JitterHasItsSpreadAndIsSeeded) {
  const auto delays = [](std::uint64_t seed) {
    SimulatedValve valve({0.010, 0.010, 0.001}, seed, "valve");
    std::vector<double> out;
    for (int i = 0; i < 2000; ++i) {
      EXPECT_TRUE(valve.write(at_ms(100 * i), i % 2 == 0).ok());
      const auto changes = valve.take_changes(at_ms(100 * i + 99));
      EXPECT_EQ(changes.size(), 1u);
      out.push_back((changes[0].time - at_ms(100 * i)).to_seconds());
    }
    return out;
  };
  const auto first = delays(3);
  EXPECT_EQ(first, delays(3));
  EXPECT_NE(first, delays(4));
  double sum = 0.0;
  double sum2 = 0.0;
  for (const double d : first) {
    sum += d - 0.010;
    sum2 += (d - 0.010) * (d - 0.010);
  }
  EXPECT_NEAR(sum / 2000.0, 0.0, 1e-4);
  EXPECT_NEAR(std::sqrt(sum2 / 2000.0), 0.001, 1e-4);
}

TEST(SimulatedValve, FaultsOverruleTheCommands) {
  SimulatedValve valve({0.004, 0.004, 0.0}, 1, "valve");
  valve.inject(at_ms(10), ValveFault::kStuckOpen);
  EXPECT_EQ(valve.take_changes(at_ms(10)).size(), 1u);
  EXPECT_TRUE(valve.flowing());
  ASSERT_TRUE(valve.write(at_ms(20), true).ok());
  ASSERT_TRUE(valve.write(at_ms(30), false).ok());
  EXPECT_TRUE(valve.take_changes(at_ms(50)).empty());
  EXPECT_TRUE(valve.flowing());
  valve.inject(at_ms(60), ValveFault::kNone);
  EXPECT_EQ(valve.take_changes(at_ms(60)).size(), 1u);
  EXPECT_FALSE(valve.flowing());
  for (const ValveFault fault : {ValveFault::kStuckClosed, ValveFault::kBlocked}) {
    ASSERT_TRUE(valve.write(at_ms(70), true).ok());
    valve.inject(at_ms(72), fault);  // overtakes the opening under way
    EXPECT_TRUE(valve.take_changes(at_ms(90)).empty());
    EXPECT_FALSE(valve.flowing());
    ASSERT_TRUE(valve.write(at_ms(91), false).ok());
    valve.inject(at_ms(95), ValveFault::kNone);
    EXPECT_TRUE(valve.take_changes(at_ms(99)).empty());
  }
}

TEST(SimulatedValve, RefusesWhenItsChangesAreNotTaken) {
  SimulatedValve valve({0.004, 0.004, 0.0}, 1, "valve");
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(valve.write(at_ms(10 * i), i % 2 == 0).ok());
  EXPECT_EQ(valve.write(at_ms(200), true).error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(valve.take_changes(at_ms(200)).size(), 16u);
  EXPECT_TRUE(valve.write(at_ms(210), true).ok());
}

TEST(SimulatedValve, RefusesBadParameters) {
  EXPECT_THROW(SimulatedValve({-0.001, 0.0, 0.0}, 1, "valve"), ConfigError);
  EXPECT_THROW(SimulatedValve({0.0, std::nan(""), 0.0}, 1, "valve"), ConfigError);
}

TEST(NozzleUseMeter, CountsOpeningsTimeAndVolume) {
  NozzleUseMeter meter(5.0);
  meter.command(at_ms(0), false);
  meter.command(at_ms(10), true);
  meter.command(at_ms(20), true);
  meter.command(at_ms(30), false);
  meter.command(at_ms(50), true);
  const NozzleUse use = meter.use(at_ms(60));
  EXPECT_EQ(use.openings, 2);
  EXPECT_NEAR(use.open_s, 0.020 + 0.010, 1e-12);
  EXPECT_NEAR(use.volume_ml, 0.030 * 5.0, 1e-12);
}

}  // namespace
}  // namespace furrow::actuation
