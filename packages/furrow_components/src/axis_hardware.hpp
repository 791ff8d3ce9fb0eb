#pragma once

#include <memory>
#include <string>

#include "furrow_actuation/emergency_input.hpp"
#include "furrow_actuation/gpio_valve.hpp"
#include "furrow_actuation/modbus_axis_driver.hpp"
#include "furrow_actuation/modbus_coil_valve.hpp"
#include "furrow_actuation/simulated_axis_driver.hpp"

namespace furrow::components {

/// The drive of an axis, its valve and its emergency stop input.
struct AxisHardwareParameters {
  std::string driver = "simulated";
  std::string valve = "simulated";
  actuation::SimulatedAxisParameters simulated{.start_ready = true};
  actuation::cia402::ModbusAxisParameters drive;
  actuation::ModbusCoilParameters coil;
  actuation::GpioValveParameters gpio;
  std::string stop_input = "none";
  actuation::EmergencyInputParameters stop;

  void visit(ParameterVisitor& v);
};

/// Throws ConfigError.
[[nodiscard]] std::unique_ptr<actuation::AxisDriver> make_axis_driver(
    const AxisHardwareParameters& parameters, const actuation::MotionLimits& limits);
/// Throws ConfigError. A simulated valve does nothing: the simulator of the robot computes the
/// spray from the driver's events.
[[nodiscard]] std::unique_ptr<actuation::ValveDriver> make_valve(
    const AxisHardwareParameters& parameters);
/// Null when there is none. Throws ConfigError.
[[nodiscard]] std::unique_ptr<actuation::EmergencyInput> make_emergency_input(
    const AxisHardwareParameters& parameters);

}  // namespace furrow::components
