#include "furrow_actuation/modbus_coil_valve.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "../simulator/output_module.hpp"
#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

using drive_simulator::OutputModule;

ModbusCoilParameters parameters(const OutputModule& module) {
  return {.port = module.port(), .coil = 3, .timeout_s = 1.0};
}

Time ms(std::int64_t milliseconds) {
  return Time() + Duration::milliseconds(milliseconds);
}

/// Waits in real time, at most 5 s: the module runs on its own clock.
template <class Condition>
bool soon(Condition condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return condition();
}

TEST(ModbusCoilValve, WritesItsCoilOnChangeAndToRefresh) {
  OutputModule module;
  {
    ModbusCoilValve valve(parameters(module));
    EXPECT_TRUE(valve.write(ms(0), false).ok());
    EXPECT_EQ(module.writes(), 1);
    EXPECT_TRUE(valve.write(ms(2), true).ok());
    EXPECT_TRUE(module.coil(3));
    EXPECT_TRUE(valve.write(ms(4), true).ok());
    EXPECT_EQ(module.writes(), 2);
    EXPECT_TRUE(valve.write(ms(104), true).ok());
    EXPECT_EQ(module.writes(), 3);
    for (const std::size_t other : {0, 1, 2, 4, 5, 6, 7}) EXPECT_FALSE(module.coil(other));
  }
  EXPECT_FALSE(module.coil(3));  // shut when the driver goes
}

TEST(ModbusCoilValve, ALostConnectionIsOpenedAgainAtOnceAndShutsFirst) {
  OutputModule module;
  ModbusCoilValve valve(parameters(module));
  EXPECT_TRUE(valve.write(ms(0), false).ok());
  EXPECT_TRUE(valve.write(ms(2), true).ok());
  module.hang_up();
  const Status lost = valve.write(ms(104), true);  // a refresh
  ASSERT_FALSE(lost.ok());
  EXPECT_EQ(lost.error().code, ErrorCode::kUnavailable);
  EXPECT_FALSE(module.coil(3));  // within the same call
  EXPECT_EQ(module.connections(), 2);
  EXPECT_TRUE(valve.write(ms(106), false).ok());
  EXPECT_TRUE(valve.write(ms(108), true).ok());
  EXPECT_TRUE(module.coil(3));
}

TEST(ModbusCoilValve, AShutThatLosesItsConnectionIsConfirmedInTheSameCall) {
  OutputModule module;
  ModbusCoilValve valve(parameters(module));
  EXPECT_TRUE(valve.write(ms(0), false).ok());
  EXPECT_TRUE(valve.write(ms(2), true).ok());
  module.hang_up();
  EXPECT_TRUE(valve.write(ms(4), false).ok());
  EXPECT_FALSE(module.coil(3));
}

TEST(ModbusCoilValve, OneLostReplyDoesNotKeepTheValveOpen) {
  OutputModule module;
  ModbusCoilParameters quick = parameters(module);
  quick.timeout_s = 0.2;
  ModbusCoilValve valve(quick);
  EXPECT_TRUE(valve.write(ms(0), false).ok());
  module.lose_reply();
  EXPECT_FALSE(valve.write(ms(2), true).ok());
  EXPECT_FALSE(module.coil(3));  // shut again by the call that did not hear of its opening
  EXPECT_TRUE(valve.write(ms(4), false).ok());
}

TEST(ModbusCoilValve, TheWatchdogIsSetCheckedAndActsWithoutTheDriver) {
  OutputModule module;
  ModbusCoilParameters watched = parameters(module);
  watched.watchdog = "wago_750";
  watched.watchdog_s = 0.3;
  ModbusCoilValve valve(watched);
  EXPECT_FALSE(valve.unconfirmed().empty());
  EXPECT_TRUE(valve.write(ms(0), false).ok());
  EXPECT_EQ(valve.unconfirmed(), "");
  EXPECT_TRUE(valve.write(ms(2), true).ok());
  EXPECT_TRUE(module.coil(3));
  EXPECT_TRUE(soon([&] { return !module.coil(3); }));  // as if the process were dead
  EXPECT_TRUE(module.watchdog_expired());
}

TEST(ModbusCoilValve, AModuleWithoutWatchdogIsToldAsNotConfirmed) {
  OutputModule module;
  ModbusCoilValve valve(parameters(module));
  EXPECT_TRUE(valve.write(ms(0), false).ok());
  EXPECT_NE(valve.unconfirmed().find("watchdog"), std::string_view::npos);
}

TEST(ModbusCoilValve, AnAbsentModuleIsUnavailable) {
  int port = 0;
  { port = OutputModule().port(); }
  ModbusCoilValve valve({.port = port});
  EXPECT_EQ(valve.write(ms(0), true).error().code, ErrorCode::kUnavailable);
}

TEST(ModbusCoilValve, RefusesBadConfiguration) {
  EXPECT_THROW(ModbusCoilValve({.address = "not an address"}), ConfigError);
  EXPECT_THROW(ModbusCoilValve({.refresh_s = 0.2, .watchdog = "wago_750", .watchdog_s = 0.3}),
               ConfigError);
}

}  // namespace
}  // namespace furrow::actuation
