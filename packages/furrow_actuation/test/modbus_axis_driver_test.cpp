#include "furrow_actuation/modbus_axis_driver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "allocation_counter.hpp"
#include "furrow_core/error.hpp"
#include "modbus_wire.hpp"

namespace furrow::actuation::cia402 {
namespace {

constexpr Phase kPhases[] = {Phase::kStarting,  Phase::kLocked,    Phase::kPrepared,
                             Phase::kPoweredOn, Phase::kOperating, Phase::kQuickStop,
                             Phase::kReacting,  Phase::kFaulted};

// The drive's own state machine, against the table of the standard.

Phase after(Phase from, std::int32_t controlword, std::int32_t before = 0) {
  SimulatedDrive drive;
  EXPECT_EQ(drive.write(0x6040, 0, before), SimulatedDrive::Answer::kOk);
  drive.force_phase(from);
  EXPECT_EQ(drive.write(0x6040, 0, controlword), SimulatedDrive::Answer::kOk);
  return drive.phase();
}

TEST(SimulatedDriveStates, EveryCommandInEveryState) {
  struct Row {
    Phase from, voltage_off, quick_stop, shutdown, switch_on, enable, fault_reset;
  };
  // Commands that the standard does not know in a state leave it as it is.
  const Row rows[] = {{Phase::kStarting, Phase::kStarting, Phase::kStarting, Phase::kStarting,
                       Phase::kStarting, Phase::kStarting, Phase::kStarting},
                      {Phase::kLocked, Phase::kLocked, Phase::kLocked, Phase::kPrepared,
                       Phase::kLocked, Phase::kLocked, Phase::kLocked},
                      {Phase::kPrepared, Phase::kLocked, Phase::kLocked, Phase::kPrepared,
                       Phase::kPoweredOn, Phase::kPoweredOn, Phase::kLocked},
                      {Phase::kPoweredOn, Phase::kLocked, Phase::kLocked, Phase::kPrepared,
                       Phase::kPoweredOn, Phase::kOperating, Phase::kLocked},
                      {Phase::kOperating, Phase::kLocked, Phase::kQuickStop, Phase::kPrepared,
                       Phase::kPoweredOn, Phase::kOperating, Phase::kLocked},
                      {Phase::kQuickStop, Phase::kLocked, Phase::kQuickStop, Phase::kQuickStop,
                       Phase::kQuickStop, Phase::kQuickStop, Phase::kLocked},
                      {Phase::kReacting, Phase::kReacting, Phase::kReacting, Phase::kReacting,
                       Phase::kReacting, Phase::kReacting, Phase::kReacting},
                      {Phase::kFaulted, Phase::kFaulted, Phase::kFaulted, Phase::kFaulted,
                       Phase::kFaulted, Phase::kFaulted, Phase::kLocked}};
  for (const Row& row : rows) {
    SCOPED_TRACE(static_cast<int>(row.from));
    EXPECT_EQ(after(row.from, 0x00), row.voltage_off);
    EXPECT_EQ(after(row.from, 0x02), row.quick_stop);
    EXPECT_EQ(after(row.from, 0x06), row.shutdown);
    EXPECT_EQ(after(row.from, 0x07), row.switch_on);
    EXPECT_EQ(after(row.from, 0x0F), row.enable);
    EXPECT_EQ(after(row.from, 0x80), row.fault_reset);
  }
  EXPECT_EQ(after(Phase::kFaulted, 0x80, 0x80), Phase::kFaulted);  // no edge, no reset
}

TEST(SimulatedDriveTime, ManySmallStepsAreOneLargeOne) {
  const auto position_after = [](double step_s) {
    SimulatedDrive drive;
    drive.force_phase(Phase::kOperating);
    EXPECT_EQ(drive.write(0x6060, 0, 1), SimulatedDrive::Answer::kOk);
    EXPECT_EQ(drive.write(0x607A, 0, 100000), SimulatedDrive::Answer::kOk);
    EXPECT_EQ(drive.write(0x6040, 0, 0x1F), SimulatedDrive::Answer::kOk);
    for (double t_s = 0.0; t_s < 0.5 - step_s / 2.0; t_s += step_s) drive.advance(step_s);
    return drive.position();
  };
  const double expected = position_after(0.5);
  EXPECT_GT(expected, 30000.0);
  EXPECT_NEAR(position_after(2e-5), expected, 100.0);
  EXPECT_NEAR(position_after(0.00037), expected, 100.0);
}

TEST(ModbusAxis, EnablesHomesAndMovesInBothModes) {
  Wire wire;
  wire.make_ready();
  EXPECT_TRUE(wire.driver().reading().homed);
  EXPECT_NEAR(wire.driver().reading().position_m, 0.0, 1e-4);
  wire.cycle({AxisCommandMode::kProfile, 0.3, 0.0});
  ASSERT_TRUE(wire.wrote);
  wire.cycle();
  EXPECT_EQ(wire.driver().reading().state, AxisState::kMoving);
  wire.run_until(AxisState::kReady);
  EXPECT_NEAR(wire.driver().reading().position_m, 0.3, 1e-3);
  const MotionProfile profile = *plan_s_curve(kLimits, {0.3, 0.0, 0.0}, -0.2);
  for (double t = 0.0; t < profile.duration_s() + 0.05; t += 0.005) {
    wire.cycle({AxisCommandMode::kCyclic, profile.at(t).position_m, 0.0});
    ASSERT_TRUE(wire.wrote);
  }
  wire.run_until(AxisState::kReady);
  EXPECT_NEAR(wire.driver().reading().position_m, -0.2, 1e-3);
  wire.cycle({AxisCommandMode::kProfile, 0.6, 0.0});
  for (int i = 0; i < 20; ++i) wire.cycle();
  wire.cycle({AxisCommandMode::kStop, 0.0, 0.0});
  wire.run_until(AxisState::kReady);
  EXPECT_LT(wire.driver().reading().position_m, 0.55);
  ASSERT_TRUE(wire.driver().disable(wire.now()).ok());
  wire.run_until(AxisState::kDisabled);
}

TEST(ModbusAxis, ADriveWithoutCyclicPositionsGoesToTheEndOfTheMovement) {
  Wire wire;
  wire.at_drive([](SimulatedDrive& d) { d.set_cyclic_offered(false); });
  wire.make_ready();
  const auto way_to = [&](double target_m, int cycles) {
    const double from_m = wire.driver().reading().position_m;
    for (int i = 0; i < cycles; ++i) {
      const double share = std::min(1.0, (i + 1) / 60.0);
      wire.cycle({AxisCommandMode::kCyclic, from_m + share * (target_m - from_m), 0.0, target_m});
      ASSERT_TRUE(wire.wrote);
    }
  };
  way_to(0.3, 150);
  EXPECT_EQ(wire.driver().reading().state, AxisState::kReady);
  EXPECT_NEAR(wire.driver().reading().position_m, 0.3, 1e-3);
  way_to(0.6, 20);  // a new target while it moves
  ASSERT_EQ(wire.driver().reading().state, AxisState::kMoving);
  way_to(-0.2, 300);
  EXPECT_NEAR(wire.driver().reading().position_m, -0.2, 1e-3);
  wire.cycle({AxisCommandMode::kCyclic, 0.0, 0.0, 0.7});
  EXPECT_FALSE(wire.wrote);  // outside the limits
  // Stopped, it goes on when the same target is given again.
  way_to(0.5, 20);
  wire.cycle({AxisCommandMode::kStop, 0.0, 0.0});
  wire.run_until(AxisState::kReady);
  EXPECT_LT(wire.driver().reading().position_m, 0.45);
  way_to(0.5, 300);
  EXPECT_NEAR(wire.driver().reading().position_m, 0.5, 1e-3);
}

TEST(ModbusAxis, ACycleAllocatesNothing) {
  Wire wire;
  wire.make_ready();
  wire.cycle({AxisCommandMode::kCyclic, 0.0, 0.0, 0.0});
  const std::size_t before = testing::allocations();
  for (int i = 0; i < 200; ++i) {
    wire.cycle({AxisCommandMode::kCyclic, 5e-4 * i, 0.0, 0.1});
    ASSERT_TRUE(wire.wrote);
  }
  EXPECT_EQ(testing::allocations(), before);
}

TEST(ModbusAxis, RefusesWhatTheAxisCannotDo) {
  Wire wire;
  wire.cycle({AxisCommandMode::kProfile, 0.1, 0.0});
  EXPECT_FALSE(wire.wrote);  // not powered
  EXPECT_FALSE(wire.driver().home(wire.now()).ok());
  wire.make_ready();
  wire.cycle({AxisCommandMode::kProfile, 0.7, 0.0});
  EXPECT_FALSE(wire.wrote);
  wire.cycle({AxisCommandMode::kCyclic, std::nan(""), 0.0});
  EXPECT_FALSE(wire.wrote);
  EXPECT_FALSE(wire.driver().enable(wire.now()).ok());
  wire.cycle();
  EXPECT_EQ(wire.driver().reading().state, AxisState::kReady);
  EXPECT_NEAR(wire.driver().reading().position_m, 0.0, 1e-4);
}

TEST(ModbusAxis, AFaultInEachStateIsLatchedUntilReset) {
  for (const Phase phase : kPhases) {
    SCOPED_TRACE(static_cast<int>(phase));
    Wire wire;
    wire.cycle();
    wire.at_drive([&](SimulatedDrive& d) {
      d.force_phase(phase);
      d.fault(0x2310);
    });
    if (phase == Phase::kFaulted) {
      wire.at_drive([](SimulatedDrive& d) {
        d.force_phase(Phase::kLocked);
        d.fault(0x2310);
      });
    }
    wire.run_until(AxisState::kFault);
    EXPECT_EQ(wire.driver().reading().fault, DriveFault::kDrive);
    EXPECT_FALSE(wire.driver().enable(wire.now()).ok());
    ASSERT_TRUE(wire.driver().reset(wire.now()).ok());
    for (int i = 0; i < 20; ++i) wire.cycle();
    EXPECT_EQ(wire.driver().reading().state, AxisState::kFault);  // the cause lasts
    wire.at_drive([](SimulatedDrive& d) { d.clear_cause(); });
    wire.run_until(AxisState::kDisabled);
    ASSERT_TRUE(wire.driver().enable(wire.now()).ok());
    wire.run_until(AxisState::kHoming);
  }
}

TEST(ModbusAxis, AConnectionCutInEachStateIsAnErrorUntilReset) {
  for (const Phase phase : kPhases) {
    SCOPED_TRACE(static_cast<int>(phase));
    Wire wire;
    wire.cycle();
    wire.at_drive([&](SimulatedDrive& d) { d.force_phase(phase); });
    wire.cut(true);
    EXPECT_FALSE(wire.cycle());
    EXPECT_FALSE(wire.wrote);
    EXPECT_EQ(wire.driver().reading().state, AxisState::kFault);
    EXPECT_EQ(wire.driver().reading().fault, DriveFault::kConnectionLost);
    EXPECT_FALSE(wire.driver().reading().homed);
    EXPECT_FALSE(wire.driver().reset(wire.now()).ok());
    wire.cut(false);
    EXPECT_FALSE(wire.cycle());  // not by itself
    ASSERT_TRUE(wire.driver().reset(wire.now()).ok());
    for (int i = 0; i < 50 && wire.driver().reading().state != AxisState::kDisabled; ++i) {
      wire.cycle();
    }
    EXPECT_EQ(wire.driver().reading().state, AxisState::kDisabled);
  }
}

TEST(ModbusAxis, EmergencyStopStopsAndLatches) {
  Wire wire;
  wire.make_ready();
  wire.cycle({AxisCommandMode::kProfile, 0.6, 0.0});
  for (int i = 0; i < 20; ++i) wire.cycle();
  ASSERT_EQ(wire.driver().reading().state, AxisState::kMoving);
  ASSERT_TRUE(wire.driver().emergency_stop(wire.now()).ok());
  for (int i = 0; i < 50; ++i) wire.cycle();
  EXPECT_EQ(wire.driver().reading().state, AxisState::kEmergencyStop);
  EXPECT_EQ(wire.driver().reading().velocity_mps, 0.0);
  EXPECT_LT(wire.driver().reading().position_m, 0.5);
  // By its option code it removes its power once it stands.
  wire.at_drive([](SimulatedDrive& d) { EXPECT_EQ(d.phase(), Phase::kLocked); });
  EXPECT_FALSE(wire.driver().reading().powered);
  EXPECT_FALSE(wire.driver().enable(wire.now()).ok());
  ASSERT_TRUE(wire.driver().reset(wire.now()).ok());
  wire.run_until(AxisState::kDisabled);
}

TEST(ModbusAxis, JamAndMissingReferenceAreReported) {
  {
    Wire wire;
    wire.make_ready();
    wire.at_drive([](SimulatedDrive& d) { d.set_jammed(true); });
    wire.cycle({AxisCommandMode::kProfile, 0.3, 0.0});
    wire.run_until(AxisState::kFault);
    EXPECT_EQ(wire.driver().reading().fault, DriveFault::kFollowingError);
  }
  Wire wire;
  wire.at_drive([](SimulatedDrive& d) { d.set_reference_missing(true); });
  wire.cycle();
  ASSERT_TRUE(wire.driver().enable(wire.now()).ok());
  wire.run_until(AxisState::kHoming);
  ASSERT_TRUE(wire.driver().home(wire.now()).ok());
  wire.run_until(AxisState::kFault);
  EXPECT_EQ(wire.driver().reading().fault, DriveFault::kHomingFailed);
}

TEST(ModbusAxis, AQuickStopReachesADriveWhoseConnectionWasLost) {
  Wire wire;
  wire.make_ready();
  wire.cycle({AxisCommandMode::kProfile, 0.6, 0.0});
  for (int i = 0; i < 20; ++i) wire.cycle();
  wire.cut(true);
  EXPECT_FALSE(wire.cycle());
  wire.cut(false);
  wire.at_drive([](SimulatedDrive& d) { ASSERT_EQ(d.phase(), Phase::kOperating); });
  ASSERT_TRUE(wire.driver().emergency_stop(wire.now()).ok());
  wire.at_drive([](SimulatedDrive& d) { EXPECT_EQ(d.phase(), Phase::kQuickStop); });
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(wire.cycle());
  EXPECT_FALSE(wire.driver().reading().powered);
  EXPECT_EQ(wire.driver().reading().state, AxisState::kEmergencyStop);
  ASSERT_TRUE(wire.driver().reset(wire.now()).ok());
  wire.run_until(AxisState::kDisabled);
  EXPECT_FALSE(wire.driver().reading().homed);
}

TEST(ModbusAxis, DisablingAMovingAxisStopsItFirst) {
  Wire wire;
  wire.make_ready();
  wire.cycle({AxisCommandMode::kProfile, 0.6, 0.0});
  for (int i = 0; i < 20; ++i) wire.cycle();
  ASSERT_TRUE(wire.driver().disable(wire.now()).ok());
  wire.cycle();
  wire.at_drive([](SimulatedDrive& d) { EXPECT_EQ(d.phase(), Phase::kQuickStop); });
  wire.run_until(AxisState::kDisabled);
  for (int i = 0; i < 20; ++i) wire.cycle();
  wire.at_drive([](SimulatedDrive& d) { EXPECT_EQ(d.phase(), Phase::kLocked); });
}

TEST(ModbusAxis, ADriverThatGoesLeavesADriveThatStopsAndRemovesItsPower) {
  SimulatedDrive drive;
  DriveServer server(drive, "127.0.0.1", 0);
  std::thread thread([&] {
    server.serve([&] {
      drive.advance(1e-3);
      return true;
    });
  });
  {
    ModbusAxisDriver driver(kLimits, Wire::parameters(server.port()));
    Time now = Time::from_seconds(1.0);
    const auto cycle = [&] {
      now += Duration::milliseconds(10);
      (void)driver.read(now, Duration::milliseconds(10)).ok();
      (void)driver.write(now, Duration::milliseconds(10), {}).ok();
    };
    cycle();
    ASSERT_TRUE(driver.enable(now).ok());
    for (int i = 0; i < 100 && driver.reading().state != AxisState::kHoming; ++i) cycle();
    ASSERT_EQ(driver.reading().state, AxisState::kHoming);
  }
  server.stop();
  thread.join();
  drive.advance(1.0);
  EXPECT_EQ(drive.phase(), Phase::kLocked);
}

TEST(ModbusAxis, ConfiguresAndChecksTheDrivesOwnProtection) {
  {
    Wire wire;
    wire.cycle();
    EXPECT_EQ(wire.driver().unconfirmed(), "drive: connection watchdog (watchdog_index is 0)");
  }
  ModbusAxisParameters watched;
  watched.watchdog_index = 0x2010;
  watched.watchdog_s = 0.1;
  {
    Wire wire(watched);
    wire.cycle();
    EXPECT_EQ(wire.driver().unconfirmed(), "");
    wire.at_drive([](SimulatedDrive& d) {
      EXPECT_EQ(d.read(0x605A, 0), 2);
      EXPECT_EQ(d.read(0x605E, 0), 2);
      EXPECT_EQ(d.read(0x6007, 0), 3);
      EXPECT_EQ(d.read(0x6085, 0), 1000000);
      EXPECT_EQ(d.read(0x2010, 0), 100);
    });
  }
  Wire wire(watched);
  wire.at_drive([](SimulatedDrive& d) {
    d.remove_object(0x6007);
    d.remove_object(0x2010);
  });
  wire.cycle();
  EXPECT_EQ(wire.driver().unconfirmed(),
            "drive: reaction to a lost connection (6007h), connection watchdog");
}

TEST(ModbusAxis, AnOperatingDriveThatHearsNothingStopsAndRemovesItsPower) {
  ModbusAxisParameters watched;
  watched.watchdog_index = 0x2010;
  Wire wire(watched);
  wire.make_ready();
  wire.cycle({AxisCommandMode::kProfile, 0.6, 0.0});
  for (int i = 0; i < 20; ++i) wire.cycle();
  wire.at_drive([](SimulatedDrive& d) {
    ASSERT_EQ(d.phase(), Phase::kOperating);
    d.advance(0.099);
    EXPECT_EQ(d.phase(), Phase::kOperating);
    d.advance(0.005);
    EXPECT_EQ(d.phase(), Phase::kQuickStop);
    d.advance(0.5);
    EXPECT_EQ(d.phase(), Phase::kLocked);
    EXPECT_EQ(d.velocity(), 0.0);
  });
}

TEST(ModbusAxis, NumbersThatDoNotFitIntoTheDrivesUnitsAreConfigurationErrors) {
  ModbusAxisParameters fine;
  fine.counts_per_m = 1e8;
  EXPECT_NO_THROW(ModbusAxisDriver(kLimits, fine));
  ModbusAxisParameters homing = fine;
  homing.homing_acceleration_mps2 = 30.0;  // 3e9 counts/s2: more than 32 bits hold
  EXPECT_THROW(ModbusAxisDriver(kLimits, homing), ConfigError);
  homing = fine;
  homing.homing_speed_mps = 30.0;
  EXPECT_THROW(ModbusAxisDriver(kLimits, homing), ConfigError);
  ModbusAxisParameters watchdog;
  watchdog.watchdog_index = 0x2010;
  watchdog.watchdog_bytes = 1;
  watchdog.watchdog_s = 1.0;  // 1000 ms in one byte
  EXPECT_THROW(ModbusAxisDriver(kLimits, watchdog), ConfigError);
}

TEST(ModbusAxis, AnAbsentDriveIsAnError) {
  SimulatedDrive drive;
  int port = 0;
  { port = DriveServer(drive, "127.0.0.1", 0).port(); }
  ModbusAxisDriver driver(kLimits, Wire::parameters(port));
  EXPECT_EQ(driver.read(Time(), Duration()).error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(driver.reading().fault, DriveFault::kConnectionLost);
  ModbusAxisParameters huge = Wire::parameters(port);
  huge.counts_per_m = 1e12;
  EXPECT_THROW(ModbusAxisDriver(kLimits, huge), ConfigError);
}

}  // namespace
}  // namespace furrow::actuation::cia402
