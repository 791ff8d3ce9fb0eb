#include "furrow_actuation/modbus_coil_valve.hpp"

#include <arpa/inet.h>
#include <modbus.h>

#include <algorithm>
#include <cmath>

#include "furrow_actuation/call_budget.hpp"
#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

// Registers of the watchdog of WAGO's 750 series couplers (manual, "Modbus functions"): its time in
// units of 100 ms, its alternative operation, in which every request feeds it, and its state.
constexpr int kWagoTime = 0x1000;
constexpr int kWagoAlternative = 0x100A;
constexpr int kWagoState = 0x1006;
constexpr double kWagoUnit_s = 0.1;
constexpr std::uint16_t kWagoRunning = 1;

Error unavailable(const char* why) {
  return {ErrorCode::kUnavailable, std::string("the valve's output module ") + why};
}

}  // namespace

struct ModbusCoilValve::Connection {
  explicit Connection(modbus_t* opened) : context(opened) {}
  ~Connection() {
    modbus_close(context);
    modbus_free(context);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void set_timeout(double seconds) const {
    constexpr double kShortest_s = 2e-4;  // libmodbus refuses 0
    const auto us = static_cast<std::uint32_t>(std::max(kShortest_s, seconds) * 1e6);
    modbus_set_response_timeout(context, us / 1000000, us % 1000000);
  }
  [[nodiscard]] bool write_coil(int coil, bool open, double timeout_s) const {
    set_timeout(timeout_s);
    return modbus_write_bit(context, coil, open ? 1 : 0) == 1;
  }
  [[nodiscard]] bool write_register(int address, std::uint16_t value, double timeout_s) const {
    set_timeout(timeout_s);
    return modbus_write_register(context, address, value) == 1;
  }
  /// -1: no answer.
  [[nodiscard]] int read_register(int address, double timeout_s) const {
    set_timeout(timeout_s);
    std::uint16_t value = 0;
    return modbus_read_registers(context, address, 1, &value) == 1 ? value : -1;
  }

  modbus_t* context;
};

ModbusCoilValve::ModbusCoilValve(const ModbusCoilParameters& parameters) : parameters_(parameters) {
  in_addr address{};
  if (inet_pton(AF_INET, parameters.address.c_str(), &address) != 1) {
    throw ConfigError("Modbus valve: '" + parameters.address + "' is not an IPv4 address");
  }
  const bool none = parameters.watchdog == "none";
  unconfirmed_ =
      std::string("output module: watchdog ") + (none ? "(watchdog is none)" : "not confirmed");
  if (!none && parameters.watchdog_s < 2.0 * parameters.refresh_s) {
    throw ConfigError(
        "Modbus valve: watchdog_s must be at least twice refresh_s, or the module's watchdog shuts "
        "a valve that works");
  }
}

ModbusCoilValve::~ModbusCoilValve() {
  // Twice: the first attempt may find that the connection was lost.
  for (int attempt = 0; attempt < 2; ++attempt) {
    written_ = false;
    next_connect_ = last_write_;
    if (write(last_write_, false).ok()) return;
  }
}

Status ModbusCoilValve::connect(Time time, double timeout_s) {
  // Held back only when this attempt fails.
  next_connect_ = time + Duration::seconds(parameters_.reconnect_s);
  written_ = false;
  modbus_t* context =
      modbus_new_tcp(parameters_.address.c_str(), static_cast<int>(parameters_.port));
  if (context == nullptr) return unavailable("cannot be addressed");
  auto connection = std::make_unique<Connection>(context);
  connection->set_timeout(timeout_s);
  if (modbus_set_slave(context, static_cast<int>(parameters_.unit)) != 0 ||
      modbus_connect(context) != 0) {
    return unavailable("takes no connection");
  }
  connection_ = std::move(connection);
  next_connect_ = time;
  return {};
}

Status ModbusCoilValve::start_watchdog() {
  if (parameters_.watchdog == "none") return {};
  const CallBudget budget(kSetupTimeouts * parameters_.timeout_s);
  const auto units = static_cast<int>(std::lround(parameters_.watchdog_s / kWagoUnit_s));
  unconfirmed_ = "output module: watchdog not confirmed";
  // A watchdog that runs already may refuse to be set again: what it holds counts.
  (void)connection_->write_register(kWagoTime, static_cast<std::uint16_t>(units), budget.left_s());
  (void)connection_->write_register(kWagoAlternative, 1, budget.left_s());
  if (connection_->read_register(kWagoTime, budget.left_s()) != units ||
      connection_->read_register(kWagoState, budget.left_s()) != kWagoRunning) {
    return unavailable("does not confirm that its watchdog runs");
  }
  unconfirmed_.clear();
  return {};
}

Status ModbusCoilValve::write(Time time, bool open) {
  const bool fresh = (time - last_write_).to_seconds() < parameters_.refresh_s;
  if (connection_ && written_ && level_ == open && fresh) return {};
  if (connection_ && set_level(time, open)) return {};
  // The level is not known: connect again at once, and shut first.
  connection_.reset();
  if (time < next_connect_) return unavailable("is not connected");
  const CallBudget budget(parameters_.timeout_s);
  if (Status status = connect(time, budget.left_s()); !status) return status;
  if (!set_level(time, false)) {
    connection_.reset();
    return unavailable("does not answer");
  }
  if (Status status = start_watchdog(); !status) {
    connection_.reset();
    next_connect_ = time + Duration::seconds(parameters_.reconnect_s);
    return status;
  }
  if (!open) return {};
  return unavailable("was not connected; it was shut");
}

bool ModbusCoilValve::set_level(Time time, bool open) {
  written_ =
      connection_->write_coil(static_cast<int>(parameters_.coil), open, parameters_.timeout_s);
  if (!written_) return false;
  level_ = open;
  last_write_ = time;
  return true;
}

}  // namespace furrow::actuation
