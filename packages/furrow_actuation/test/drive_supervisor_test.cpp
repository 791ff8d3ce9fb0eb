#include "furrow_actuation/drive_supervisor.hpp"

#include <gtest/gtest.h>

#include "furrow_actuation/simulated_axis_driver.hpp"

namespace furrow::actuation {
namespace {

constexpr MotionLimits kLimits{-0.7, 0.7, 5.0, 50.0, 2000.0};
constexpr Duration kPeriod = Duration::milliseconds(2);

/// A simulated drive and its supervisor, stepped together.
struct Bench {
  SimulatedAxisDriver driver;
  DriveSupervisor supervisor;
  Time now;

  explicit Bench(const SimulatedAxisParameters& parameters = {.start_position_m = 0.3})
      : driver(kLimits, parameters) {}

  void run(double seconds) {
    const Time end = now + Duration::seconds(seconds);
    for (; now < end; now += kPeriod) {
      (void)driver.read(now, kPeriod).ok();
      supervisor.update(now, driver);
    }
  }
  [[nodiscard]] AxisState state() const { return driver.reading().state; }
};

TEST(DriveSupervisor, EnablesAndHomesAtTheStart) {
  Bench bench;
  EXPECT_EQ(bench.state(), AxisState::kDisabled);
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
  EXPECT_TRUE(bench.driver.reading().homed);
  EXPECT_NEAR(bench.driver.reading().position_m, 0.0, 1e-4);
  EXPECT_FALSE(bench.supervisor.busy());
}

TEST(DriveSupervisor, LeavesADriveThatIsReadyAsItIs) {
  Bench bench({.start_position_m = 0.3, .start_ready = true});
  bench.run(0.1);
  EXPECT_FALSE(bench.supervisor.busy());
  EXPECT_DOUBLE_EQ(bench.driver.reading().position_m, 0.3);
}

TEST(DriveSupervisor, AFaultStaysUntilReset) {
  Bench bench;
  bench.run(2.0);
  bench.driver.inject(bench.now, DriveFault::kDrive);
  bench.driver.clear_faults();
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kFault);
  bench.supervisor.reset(bench.now);
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
}

TEST(DriveSupervisor, AnEmergencyStopStaysUntilReset) {
  Bench bench;
  bench.run(2.0);
  ASSERT_TRUE(bench.driver.emergency_stop(bench.now).ok());
  bench.run(1.0);
  EXPECT_EQ(bench.state(), AxisState::kEmergencyStop);
  bench.supervisor.reset(bench.now);
  bench.run(1.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
}

TEST(DriveSupervisor, PowerThatWasSwitchedOffStaysOff) {
  Bench bench;
  bench.run(2.0);
  ASSERT_TRUE(bench.driver.disable(bench.now).ok());
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kDisabled);
  bench.supervisor.reset(bench.now);
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
}

TEST(DriveSupervisor, AResetWhoseCauseLastsIsGivenUpAndSaysWhy) {
  Bench bench;
  bench.run(2.0);
  bench.driver.inject(bench.now, DriveFault::kDrive);
  bench.supervisor.reset(bench.now);
  bench.run(DriveSupervisor::kPatience.to_seconds() + 0.5);
  EXPECT_FALSE(bench.supervisor.busy());
  EXPECT_EQ(bench.supervisor.refusal(), "the cause of the fault is still there");
  bench.driver.clear_faults();
  bench.run(1.0);
  EXPECT_EQ(bench.state(), AxisState::kFault);  // too late: it wants another reset
}

TEST(DriveSupervisor, AFailedHomingIsNotTriedForever) {
  Bench bench({.homing_timeout_s = 0.2, .start_position_m = 0.3});
  bench.driver.set_reference_missing(true);
  bench.run(3.0);
  EXPECT_EQ(bench.driver.reading().fault, DriveFault::kHomingFailed);
  EXPECT_FALSE(bench.supervisor.busy());
  bench.driver.set_reference_missing(false);
  bench.supervisor.reset(bench.now);
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
}

TEST(DriveSupervisor, WaitsForADriveThatIsNotThereYet) {
  Bench bench;
  bench.driver.set_connected(bench.now, false);
  bench.run(1.0);
  EXPECT_TRUE(bench.supervisor.busy());
  EXPECT_EQ(bench.state(), AxisState::kFault);
  bench.driver.set_connected(bench.now, true);
  bench.run(3.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
}

TEST(DriveSupervisor, ALostConnectionInServiceStaysUntilReset) {
  Bench bench;
  bench.run(2.0);
  bench.driver.set_connected(bench.now, false);
  bench.run(0.5);
  bench.driver.set_connected(bench.now, true);
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kFault);
  bench.supervisor.reset(bench.now);
  bench.run(2.0);
  EXPECT_EQ(bench.state(), AxisState::kReady);
}

}  // namespace
}  // namespace furrow::actuation
