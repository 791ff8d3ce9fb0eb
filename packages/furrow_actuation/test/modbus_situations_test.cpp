// Faults, cuts and requests in everything that a driver may be doing.

#include <gtest/gtest.h>

#include "furrow_actuation/modbus_axis_driver.hpp"
#include "modbus_wire.hpp"

namespace furrow::actuation::cia402 {
namespace {

/// What a driver may be doing when something happens.
struct Situation {
  const char* name;
  AxisState state;
  void (*enter)(Wire&);
};

void move_far(Wire& wire, AxisCommandMode mode) {
  wire.make_ready();
  for (int i = 0; i < 20; ++i) wire.cycle({mode, 0.005 * (i + 1), 0.0, 0.6});
}

constexpr Situation kSituations[] = {
    {"disabled", AxisState::kDisabled, [](Wire& wire) { wire.cycle(); }},
    {"powered", AxisState::kHoming,
     [](Wire& wire) {
       wire.cycle();
       ASSERT_TRUE(wire.driver().enable(wire.now()).ok());
       wire.run_until(AxisState::kHoming);
     }},
    {"homing", AxisState::kHoming,
     [](Wire& wire) {
       wire.cycle();
       ASSERT_TRUE(wire.driver().enable(wire.now()).ok());
       wire.run_until(AxisState::kHoming);
       ASSERT_TRUE(wire.driver().home(wire.now()).ok());
       for (int i = 0; i < 10; ++i) wire.cycle();
     }},
    {"ready", AxisState::kReady, [](Wire& wire) { wire.make_ready(); }},
    {"moving by a profile", AxisState::kMoving,
     [](Wire& wire) {
       wire.make_ready();
       wire.cycle({AxisCommandMode::kProfile, 0.6, 0.0, std::nullopt});
       for (int i = 0; i < 20; ++i) wire.cycle();
     }},
    {"moving by set-points", AxisState::kMoving,
     [](Wire& wire) { move_far(wire, AxisCommandMode::kCyclic); }},
    {"stopped by an emergency", AxisState::kEmergencyStop, [](Wire& wire) {
       move_far(wire, AxisCommandMode::kCyclic);
       ASSERT_TRUE(wire.driver().emergency_stop(wire.now()).ok());
       wire.cycle();
     }}};

TEST(ModbusSituations, AFaultInEachSituationStopsTheDriveAndIsLatched) {
  for (const Situation& situation : kSituations) {
    SCOPED_TRACE(situation.name);
    Wire wire;
    situation.enter(wire);
    ASSERT_EQ(wire.driver().reading().state, situation.state);
    wire.at_drive([](SimulatedDrive& d) { d.fault(0x2310); });
    for (int i = 0; i < 60; ++i) wire.cycle({AxisCommandMode::kCyclic, 0.0, 0.0, 0.0});
    wire.at_drive([](SimulatedDrive& d) {
      EXPECT_EQ(d.phase(), Phase::kFaulted);
      EXPECT_EQ(d.velocity(), 0.0);
    });
    const bool stopped = situation.state == AxisState::kEmergencyStop;
    EXPECT_EQ(wire.driver().reading().state,
              stopped ? AxisState::kEmergencyStop : AxisState::kFault);
    EXPECT_EQ(wire.driver().reading().fault, DriveFault::kDrive);
    EXPECT_FALSE(wire.wrote);
    EXPECT_FALSE(wire.driver().enable(wire.now()).ok());
    EXPECT_FALSE(wire.driver().home(wire.now()).ok());
    wire.at_drive([](SimulatedDrive& d) { d.clear_cause(); });
    for (int i = 0; i < 20; ++i) wire.cycle();
    EXPECT_NE(wire.driver().reading().state, AxisState::kDisabled);  // not by itself
    ASSERT_TRUE(wire.driver().reset(wire.now()).ok());
    wire.run_until(AxisState::kDisabled);
  }
}

TEST(ModbusSituations, ACutInEachSituationIsAFaultUntilReset) {
  for (const Situation& situation : kSituations) {
    SCOPED_TRACE(situation.name);
    Wire wire;
    situation.enter(wire);
    wire.cut(true);
    EXPECT_FALSE(wire.cycle());
    EXPECT_EQ(wire.driver().reading().state, AxisState::kFault);
    EXPECT_EQ(wire.driver().reading().fault, DriveFault::kConnectionLost);
    EXPECT_FALSE(wire.wrote);
    EXPECT_FALSE(wire.driver().enable(wire.now()).ok());
    wire.cut(false);
    EXPECT_FALSE(wire.cycle());  // not by itself
    ASSERT_TRUE(wire.driver().reset(wire.now()).ok());
    wire.run_until(AxisState::kDisabled);
    wire.at_drive([](SimulatedDrive& d) { EXPECT_NE(d.phase(), Phase::kOperating); });
    EXPECT_FALSE(wire.driver().reading().homed);
  }
}

TEST(ModbusSituations, EachSituationRefusesWhatDoesNotBelongToIt) {
  for (const Situation& situation : kSituations) {
    SCOPED_TRACE(situation.name);
    const bool usable =
        situation.state == AxisState::kReady || situation.state == AxisState::kMoving;
    {
      Wire wire;
      situation.enter(wire);
      wire.cycle({AxisCommandMode::kProfile, 0.1, 0.0, std::nullopt});
      EXPECT_EQ(wire.wrote, usable);
    }
    {
      Wire wire;
      situation.enter(wire);
      const bool may =
          situation.state == AxisState::kHoming || situation.state == AxisState::kReady;
      EXPECT_EQ(wire.driver().home(wire.now()).ok(), may);
    }
    Wire wire;
    situation.enter(wire);
    EXPECT_EQ(wire.driver().enable(wire.now()).ok(), situation.state == AxisState::kDisabled);
    ASSERT_TRUE(wire.driver().emergency_stop(wire.now()).ok());
    EXPECT_EQ(wire.driver().reading().state, AxisState::kEmergencyStop);
  }
}

}  // namespace
}  // namespace furrow::actuation::cia402
