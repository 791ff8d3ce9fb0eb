#include "furrow_actuation/modbus_coil_valve.hpp"

namespace furrow::actuation {

void ModbusCoilParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "address", .description = "IP address of the output module"}, address);
  v.visit({.name = "port", .description = "its Modbus TCP port", .min = 1, .max = 65535}, port);
  v.visit({.name = "unit", .description = "its unit identifier", .min = 0, .max = 247}, unit);
  v.visit({.name = "coil", .description = "the valve's coil, from 0", .min = 0, .max = 65535},
          coil);
  v.visit({.name = "timeout_s",
           .unit = "s",
           .description = "an exchange that takes longer is a lost connection",
           .min = 0.001,
           .max = 5.0},
          timeout_s);
  v.visit({.name = "refresh_s",
           .unit = "s",
           .description = "the level is written again after this time",
           .min = 0.005,
           .max = 60.0},
          refresh_s);
  v.visit({.name = "reconnect_s",
           .unit = "s",
           .description = "least time between two attempts to connect that fail; a connection that "
                          "is lost is opened again at once",
           .min = 0.01,
           .max = 60.0},
          reconnect_s);
  v.visit({.name = "watchdog",
           .description = "the module's own watchdog, which shuts its outputs when nothing is "
                          "written; set and checked at each connection. none: it has none, or it "
                          "is set by other means",
           .choices = {"none", "wago_750"}},
          watchdog);
  v.visit({.name = "watchdog_s",
           .unit = "s",
           .description = "its time; at least twice the refresh",
           .min = 0.1,
           .max = 60.0},
          watchdog_s);
}

}  // namespace furrow::actuation
