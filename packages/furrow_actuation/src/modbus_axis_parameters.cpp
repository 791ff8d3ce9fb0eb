#include "furrow_actuation/modbus_axis_driver.hpp"

namespace furrow::actuation::cia402 {

void ModbusAxisParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "address", .description = "IP address of the drive"}, address);
  v.visit({.name = "port", .description = "its Modbus TCP port", .min = 1, .max = 65535}, port);
  v.visit({.name = "unit", .description = "its unit identifier", .min = 0, .max = 255}, unit);
  v.visit({.name = "timeout_s",
           .unit = "s",
           .description = "a cycle's exchanges with the drive that together take longer are a lost "
                          "connection",
           .min = 0.001,
           .max = 5.0},
          timeout_s);
  v.visit({.name = "counts_per_m",
           .description = "the drive's position units in a meter",
           .min = 1.0,
           .max = 1e8},
          counts_per_m);
  v.visit({.name = "homing_speed_mps",
           .unit = "m/s",
           .description = "speed of the search for the reference",
           .min = 1e-4,
           .max = 5.0},
          homing_speed_mps);
  v.visit({.name = "homing_acceleration_mps2",
           .unit = "m/s2",
           .description = "acceleration while homing",
           .min = 1e-3,
           .max = 100.0},
          homing_acceleration_mps2);
  v.visit({.name = "homing_method",
           .description = "object 6098h, as the drive's manual numbers the methods",
           .min = -128,
           .max = 127},
          homing_method);
  v.visit({.name = "has_following_error",
           .description = "the drive offers object 60F4h; otherwise its own limit alone watches"},
          has_following_error);
  v.visit({.name = "watchdog_index",
           .description = "object of the drive's connection watchdog in its manual, such as 8208 "
                          "(2010h); 0: it has none, or it is set by other means",
           .min = 0,
           .max = 65535},
          watchdog_index);
  v.visit({.name = "watchdog_sub_index", .description = "its sub-index", .min = 0, .max = 255},
          watchdog_sub_index);
  v.visit({.name = "watchdog_bytes", .description = "its size", .min = 1, .max = 4},
          watchdog_bytes);
  v.visit({.name = "watchdog_s",
           .unit = "s",
           .description = "a drive that hears nothing for longer makes a quick stop by itself",
           .min = 0.01,
           .max = 10.0},
          watchdog_s);
  v.visit({.name = "watchdog_unit_s",
           .unit = "s",
           .description = "what one count of the watchdog's object stands for",
           .min = 1e-6,
           .max = 1.0},
          watchdog_unit_s);
}

}  // namespace furrow::actuation::cia402
