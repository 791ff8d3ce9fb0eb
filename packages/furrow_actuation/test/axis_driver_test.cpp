#include <gtest/gtest.h>

#include <cmath>

#include "furrow_actuation/simulated_axis_driver.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"

namespace furrow::actuation {
namespace {

constexpr MotionLimits kLimits{-0.695, 0.695, 5.0, 50.0, 2000.0};
constexpr Duration kPeriod = Duration::milliseconds(2);

SimulatedAxisParameters ready() {
  SimulatedAxisParameters parameters;
  parameters.start_ready = true;
  return parameters;
}

class DriverRun {
 public:
  explicit DriverRun(const SimulatedAxisParameters& parameters) : driver(kLimits, parameters) {
    cycle();
  }
  void cycle() {
    now += kPeriod;
    connected = driver.read(now, kPeriod).ok();
  }
  void run(double seconds) {
    for (double t = 0.0; t < seconds; t += kPeriod.to_seconds()) cycle();
  }
  Status write(AxisCommandMode mode, double position_m = 0.0, double velocity_mps = 0.0) {
    return driver.write(now, kPeriod, {mode, position_m, velocity_mps});
  }
  [[nodiscard]] AxisState state() const { return driver.reading().state; }
  [[nodiscard]] double position() const { return driver.reading().position_m; }

  SimulatedAxisDriver driver;
  Time now = Time::from_seconds(1.0);
  bool connected = true;
};

TEST(SimulatedAxis, GoesFromDisabledOverHomingToReady) {
  SimulatedAxisParameters parameters;
  parameters.start_position_m = 0.4;
  DriverRun run(parameters);
  EXPECT_EQ(run.state(), AxisState::kDisabled);
  EXPECT_FALSE(run.write(AxisCommandMode::kProfile, 0.1).ok());
  EXPECT_FALSE(run.driver.home(run.now).ok());
  ASSERT_TRUE(run.driver.enable(run.now).ok());
  EXPECT_EQ(run.state(), AxisState::kHoming);
  EXPECT_FALSE(run.write(AxisCommandMode::kProfile, 0.1).ok());
  EXPECT_FALSE(run.driver.enable(run.now).ok());
  ASSERT_TRUE(run.driver.home(run.now).ok());
  run.run(0.3);
  EXPECT_EQ(run.state(), AxisState::kHoming);
  EXPECT_LE(std::abs(run.driver.reading().velocity_mps), parameters.homing_speed_mps + 1e-9);
  run.run(0.9);
  EXPECT_EQ(run.state(), AxisState::kReady);
  EXPECT_TRUE(run.driver.reading().homed);
  EXPECT_NEAR(run.position(), 0.0, 1e-6);
  ASSERT_TRUE(run.driver.disable(run.now).ok());
  EXPECT_EQ(run.state(), AxisState::kDisabled);
  ASSERT_TRUE(run.driver.enable(run.now).ok());
  EXPECT_EQ(run.state(), AxisState::kReady);
}

TEST(SimulatedAxis, ProfileModeTakesTheProfilesTime) {
  DriverRun run(ready());
  ASSERT_TRUE(run.write(AxisCommandMode::kProfile, 0.6).ok());
  const double duration_s = plan_s_curve(kLimits, {}, 0.6)->duration_s();
  run.run(duration_s - 0.010);
  EXPECT_EQ(run.state(), AxisState::kMoving);
  run.run(0.014);
  EXPECT_EQ(run.state(), AxisState::kReady);
  EXPECT_NEAR(run.position(), 0.6, 1e-9);
}

TEST(SimulatedAxis, FollowsAStreamOfSetpointsWithItsLag) {
  SimulatedAxisParameters parameters = ready();
  parameters.lag_s = 0.005;
  DriverRun run(parameters);
  const MotionProfile profile = *plan_s_curve(kLimits, {}, 0.69);
  double behind_at_cruise = 0.0;
  for (double t = 0.0; t < profile.duration_s() + 0.05; t += 0.002) {
    const MotionState next = profile.at(t + 0.002);
    ASSERT_TRUE(run.write(AxisCommandMode::kCyclic, next.position_m, next.velocity_mps).ok());
    run.cycle();
    ASSERT_LE(run.position(), 0.69 + 1e-9);
    if (t > 0.14 && t < 0.145) behind_at_cruise = run.driver.reading().following_error_m;
  }
  // In steady motion a first-order lag is velocity times lag behind.
  EXPECT_NEAR(behind_at_cruise, 5.0 * 0.005, 2e-3);
  EXPECT_NEAR(run.position(), 0.69, 1e-5);
  EXPECT_EQ(run.state(), AxisState::kReady);
}

TEST(SimulatedAxis, StopsByItselfWhenTheStreamDriesUp) {
  DriverRun run(ready());
  const MotionProfile profile = *plan_s_curve(kLimits, {}, 0.69);
  for (double t = 0.0; t < 0.12; t += 0.002) {
    const MotionState next = profile.at(t + 0.002);
    ASSERT_TRUE(run.write(AxisCommandMode::kCyclic, next.position_m, next.velocity_mps).ok());
    run.cycle();
  }
  EXPECT_EQ(run.state(), AxisState::kMoving);
  run.run(0.3);
  EXPECT_EQ(run.state(), AxisState::kReady);
  EXPECT_LT(run.position(), 0.695);
}

TEST(SimulatedAxis, RefusesWhatItCannotDo) {
  DriverRun run(ready());
  EXPECT_EQ(run.write(AxisCommandMode::kProfile, 0.7).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(run.write(AxisCommandMode::kCyclic, -0.7).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(run.write(AxisCommandMode::kCyclic, std::nan("")).error().code,
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(run.position(), 0.0);
  EXPECT_EQ(run.state(), AxisState::kReady);
  EXPECT_EQ(run.write(AxisCommandMode::kCyclic, 0.3).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(run.driver.reading().fault, DriveFault::kFollowingError);
}

TEST(SimulatedAxis, JammedAxisFaultsByItsFollowingError) {
  DriverRun run(ready());
  run.driver.set_jammed(true);
  ASSERT_TRUE(run.write(AxisCommandMode::kProfile, 0.5).ok());
  run.run(0.5);
  EXPECT_EQ(run.state(), AxisState::kFault);
  EXPECT_EQ(run.driver.reading().fault, DriveFault::kFollowingError);
  EXPECT_EQ(run.position(), 0.0);
  run.driver.set_jammed(false);
  ASSERT_TRUE(run.driver.reset(run.now).ok());
  ASSERT_TRUE(run.driver.enable(run.now).ok());
  run.cycle();
  EXPECT_EQ(run.state(), AxisState::kReady);
  EXPECT_NEAR(run.position(), 0.0, 1e-9);
}

TEST(SimulatedAxis, AnAxisThatComesFreeIsNoFasterThanItCanBe) {
  SimulatedAxisParameters parameters = ready();
  parameters.lag_s = 0.002;
  DriverRun run(parameters);
  run.driver.set_jammed(true);
  ASSERT_TRUE(run.write(AxisCommandMode::kProfile, 0.5).ok());
  while (run.driver.reading().following_error_m < 0.03) run.cycle();
  ASSERT_NE(run.state(), AxisState::kFault);
  run.driver.set_jammed(false);
  for (int i = 0; i < 50; ++i) {
    const double before_m = run.position();
    run.cycle();
    ASSERT_LE(std::abs(run.driver.reading().velocity_mps), kLimits.max_velocity_mps);
    ASSERT_LE(std::abs(run.position() - before_m),
              kLimits.max_velocity_mps * kPeriod.to_seconds() + 1e-9);
  }
}

TEST(SimulatedAxis, FaultsAndEmergencyStopAreLatched) {
  for (const DriveFault fault :
       {DriveFault::kDrive, DriveFault::kPositionLimit, DriveFault::kFollowingError}) {
    DriverRun run(ready());
    ASSERT_TRUE(run.write(AxisCommandMode::kProfile, 0.6).ok());
    run.run(0.1);
    run.driver.inject(run.now, fault);
    EXPECT_EQ(run.state(), AxisState::kFault);
    run.run(0.5);
    EXPECT_EQ(run.driver.reading().fault, fault);
    EXPECT_FALSE(run.write(AxisCommandMode::kProfile, 0.0).ok());
    EXPECT_FALSE(run.driver.enable(run.now).ok());
    EXPECT_FALSE(run.driver.reset(run.now).ok());
    run.driver.clear_faults();
    EXPECT_TRUE(run.driver.reset(run.now).ok());
    EXPECT_EQ(run.state(), AxisState::kDisabled);
  }
  DriverRun run(ready());
  ASSERT_TRUE(run.write(AxisCommandMode::kProfile, 0.6).ok());
  run.run(0.1);
  ASSERT_TRUE(run.driver.emergency_stop(run.now).ok());
  EXPECT_FALSE(run.driver.reset(run.now).ok());  // still stopping
  run.run(0.3);
  EXPECT_EQ(run.state(), AxisState::kEmergencyStop);
  EXPECT_EQ(run.driver.reading().velocity_mps, 0.0);
  EXPECT_TRUE(run.driver.reset(run.now).ok());
}

TEST(SimulatedAxis, ACutWireIsAnErrorAndTheDriveStops) {
  DriverRun run(ready());
  ASSERT_TRUE(run.write(AxisCommandMode::kProfile, 0.6).ok());
  run.run(0.1);
  run.driver.set_connected(run.now, false);
  run.cycle();
  EXPECT_FALSE(run.connected);
  EXPECT_EQ(run.write(AxisCommandMode::kStop).error().code, ErrorCode::kUnavailable);
  EXPECT_FALSE(run.driver.reset(run.now).ok());
  EXPECT_FALSE(run.driver.home(run.now).ok());
  EXPECT_FALSE(run.driver.disable(run.now).ok());
  EXPECT_FALSE(run.driver.emergency_stop(run.now).ok());
  run.run(0.4);
  run.driver.set_connected(run.now, true);
  run.cycle();
  EXPECT_EQ(run.state(), AxisState::kFault);
  EXPECT_EQ(run.driver.reading().fault, DriveFault::kConnectionLost);
  EXPECT_LT(run.position(), 0.6);
  EXPECT_TRUE(run.driver.reset(run.now).ok());
}

TEST(SimulatedAxis, HomingWithoutReferenceTimesOut) {
  SimulatedAxisParameters parameters;
  parameters.homing_timeout_s = 1.0;
  DriverRun run(parameters);
  run.driver.set_reference_missing(true);
  ASSERT_TRUE(run.driver.enable(run.now).ok());
  ASSERT_TRUE(run.driver.home(run.now).ok());
  run.run(1.1);
  EXPECT_EQ(run.state(), AxisState::kFault);
  EXPECT_EQ(run.driver.reading().fault, DriveFault::kHomingFailed);
}

/// One request, order, fault or cut, whatever the drive is doing.
void disturb(DriverRun& run, Random& random) {
  switch (random.integer(0, 11)) {
    case 0:
      (void)run.driver.enable(run.now).ok();
      break;
    case 1:
      (void)run.driver.disable(run.now).ok();
      break;
    case 2:
      (void)run.driver.home(run.now).ok();
      break;
    case 3:
      (void)run.driver.emergency_stop(run.now).ok();
      break;
    case 4:
      run.driver.inject(run.now, random.bernoulli(0.5) ? DriveFault::kDrive : DriveFault::kNone);
      break;
    case 5:
      run.driver.set_connected(run.now, random.bernoulli(0.7));
      break;
    case 6:
      (void)run.write(AxisCommandMode::kStop).ok();
      break;
    case 7:  // the operator sets everything right
      run.driver.set_connected(run.now, true);
      run.driver.clear_faults();
      (void)run.driver.reset(run.now).ok();
      (void)run.driver.enable(run.now).ok();
      break;
    default:
      (void)run.write(AxisCommandMode::kProfile, random.uniform(-0.8, 0.8)).ok();
      break;
  }
}

TEST(SimulatedAxis, StaysWithinItsLimitsWhateverItIsTold) {
  int moved = 0;
  int faults = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed, "drive");
    SimulatedAxisParameters parameters;
    parameters.start_ready = random.bernoulli(0.7);
    parameters.start_position_m = random.uniform(-0.695, 0.695);
    DriverRun run(parameters);
    double velocity_mps = 0.0;
    for (int i = 0; i < 300; ++i) {
      if (random.bernoulli(0.05)) disturb(run, random);
      run.cycle();
      const AxisReading& reading = run.driver.reading();
      ASSERT_LE(std::abs(reading.position_m), kLimits.upper_m + 1e-9);
      ASSERT_LE(std::abs(reading.velocity_mps), kLimits.max_velocity_mps + 1e-9);
      ASSERT_LE(std::abs(reading.velocity_mps - velocity_mps) / kPeriod.to_seconds(),
                kLimits.max_acceleration_mps2 * (1.0 + 1e-6));
      velocity_mps = reading.velocity_mps;
      moved += reading.state == AxisState::kMoving ? 1 : 0;
      faults += reading.state == AxisState::kFault ? 1 : 0;
    }
  }
  EXPECT_GT(moved, 100000);
  EXPECT_GT(faults, 50000);
}

TEST(SimulatedAxis, RefusesBadParameters) {
  SimulatedAxisParameters outside = ready();
  outside.start_position_m = 1.0;
  EXPECT_THROW(SimulatedAxisDriver(kLimits, outside), ConfigError);
  MotionLimits none = kLimits;
  none.max_velocity_mps = 0.0;
  EXPECT_THROW(SimulatedAxisDriver(none, ready()), ConfigError);
}

}  // namespace
}  // namespace furrow::actuation
