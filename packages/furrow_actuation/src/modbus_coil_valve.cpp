#include "furrow_actuation/modbus_coil_valve.hpp"

#include <arpa/inet.h>
#include <modbus.h>

#include "furrow_core/error.hpp"

namespace furrow::actuation {

struct ModbusCoilValve::Connection {
  explicit Connection(modbus_t* opened) : context(opened) {}
  ~Connection() {
    modbus_close(context);
    modbus_free(context);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  modbus_t* context;
};

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
           .description = "least time between two attempts to connect",
           .min = 0.01,
           .max = 60.0},
          reconnect_s);
}

ModbusCoilValve::ModbusCoilValve(const ModbusCoilParameters& parameters) : parameters_(parameters) {
  in_addr address{};
  if (inet_pton(AF_INET, parameters.address.c_str(), &address) != 1) {
    throw ConfigError("Modbus valve: '" + parameters.address + "' is not an IPv4 address");
  }
}

ModbusCoilValve::~ModbusCoilValve() {
  if (!connection_) return;
  modbus_write_bit(connection_->context, static_cast<int>(parameters_.coil), 0);
}

Status ModbusCoilValve::connect(Time time) {
  next_connect_ = time + Duration::seconds(parameters_.reconnect_s);
  auto connection = std::make_unique<Connection>(
      modbus_new_tcp(parameters_.address.c_str(), static_cast<int>(parameters_.port)));
  const auto timeout_us = static_cast<std::uint32_t>(parameters_.timeout_s * 1e6);
  modbus_set_response_timeout(connection->context, timeout_us / 1000000, timeout_us % 1000000);
  if (modbus_set_slave(connection->context, static_cast<int>(parameters_.unit)) != 0 ||
      modbus_connect(connection->context) != 0) {
    return Error{ErrorCode::kUnavailable, "no connection to the valve's output module"};
  }
  connection_ = std::move(connection);
  written_ = false;
  return {};
}

Status ModbusCoilValve::write(Time time, bool open) {
  if (!connection_) {
    if (time < next_connect_) {
      return Error{ErrorCode::kUnavailable, "the valve's output module is not connected"};
    }
    if (Status status = connect(time); !status) return status;
  }
  const bool fresh = (time - last_write_).to_seconds() < parameters_.refresh_s;
  if (written_ && level_ == open && fresh) return {};
  if (modbus_write_bit(connection_->context, static_cast<int>(parameters_.coil), open ? 1 : 0) !=
      1) {
    connection_.reset();
    next_connect_ = time + Duration::seconds(parameters_.reconnect_s);
    return Error{ErrorCode::kUnavailable, "the valve's output module does not answer"};
  }
  written_ = true;
  level_ = open;
  last_write_ = time;
  return {};
}

}  // namespace furrow::actuation
