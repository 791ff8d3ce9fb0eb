#include "axis_hardware.hpp"

namespace furrow::components {
namespace {

class SimulatedElsewhere final : public actuation::ValveDriver {
 public:
  Status write(Time, bool) override { return {}; }
};

}  // namespace

void AxisHardwareParameters::visit(ParameterVisitor& v) {
  v.visit(
      {.name = "driver",
       .description = "simulated: a servo with the limits of the URDF; cia402_modbus: a CiA 402 "
                      "drive behind a Modbus TCP gateway (drive_*)",
       .choices = {"simulated", "cia402_modbus"}},
      driver);
  v.visit({.name = "valve",
           .description =
               "simulated: the simulator of the robot sprays; modbus_coils: an output module "
               "(coil_*); gpio: a line of this computer (gpio_*)",
           .choices = {"simulated", "modbus_coils", "gpio"}},
          valve);
  PrefixedVisitor simulated_visitor(v, "simulated_");
  simulated.visit(simulated_visitor);
  PrefixedVisitor drive_visitor(v, "drive_");
  drive.visit(drive_visitor);
  PrefixedVisitor coil_visitor(v, "coil_");
  coil.visit(coil_visitor);
  PrefixedVisitor gpio_visitor(v, "gpio_");
  gpio.visit(gpio_visitor);
  v.visit({.name = "stop_input",
           .description = "emergency stop input beside the topic; gpio: a line of this computer "
                          "(stop_gpio_*)",
           .choices = {"none", "gpio"}},
          stop_input);
  PrefixedVisitor stop_visitor(v, "stop_gpio_");
  stop.visit(stop_visitor);
}

std::unique_ptr<actuation::AxisDriver> make_axis_driver(const AxisHardwareParameters& parameters,
                                                        const actuation::MotionLimits& limits) {
  if (parameters.driver == "cia402_modbus") {
    return std::make_unique<actuation::cia402::ModbusAxisDriver>(limits, parameters.drive);
  }
  return std::make_unique<actuation::SimulatedAxisDriver>(limits, parameters.simulated);
}

std::unique_ptr<actuation::ValveDriver> make_valve(const AxisHardwareParameters& parameters) {
  if (parameters.valve == "modbus_coils") {
    return std::make_unique<actuation::ModbusCoilValve>(parameters.coil);
  }
  if (parameters.valve == "gpio") {
    const bool low = parameters.gpio.active_low;
    return std::make_unique<actuation::GpioValve>(actuation::open_gpio_line(parameters.gpio, low),
                                                  low);
  }
  return std::make_unique<SimulatedElsewhere>();
}

std::unique_ptr<actuation::EmergencyInput> make_emergency_input(
    const AxisHardwareParameters& parameters) {
  if (parameters.stop_input != "gpio") return nullptr;
  return std::make_unique<actuation::EmergencyInput>(actuation::open_gpio_input(parameters.stop),
                                                     parameters.stop.released_high);
}

}  // namespace furrow::components
