#pragma once

#include <memory>
#include <string>

#include "furrow_actuation/nozzle.hpp"

namespace furrow::actuation {

struct ModbusCoilParameters {
  std::string address = "127.0.0.1";
  std::int64_t port = 502;
  std::int64_t unit = 1;
  std::int64_t coil = 0;
  double timeout_s = 0.005;
  double refresh_s = 0.1;
  double reconnect_s = 0.05;
  std::string watchdog = "none";
  double watchdog_s = 0.3;

  void visit(ParameterVisitor& v);
};

/// A valve at a coil of a Modbus TCP output module. The level is written when it changes, and again
/// every refresh_s, which feeds the module's own watchdog. At each connection the valve is shut
/// first, and the watchdog is set and checked. A connection that is lost is opened again within the
/// same call; the opening that lost it fails.
class ModbusCoilValve final : public ValveDriver {
 public:
  /// Throws ConfigError for an address or numbers that are not usable.
  explicit ModbusCoilValve(const ModbusCoilParameters& parameters);
  /// Shuts the valve, if the module answers.
  ~ModbusCoilValve() override;
  ModbusCoilValve(const ModbusCoilValve&) = delete;
  ModbusCoilValve& operator=(const ModbusCoilValve&) = delete;

  /// Blocks for 3 timeout_s at most, and once at each connection for kSetupTimeouts more while the
  /// watchdog is set, with the valve shut. kUnavailable: the module did not confirm the level.
  Status write(Time time, bool open) override;
  [[nodiscard]] std::string_view unconfirmed() const override { return unconfirmed_; }

  static constexpr double kSetupTimeouts = 10.0;

 private:
  struct Connection;
  [[nodiscard]] Status connect(Time time, double timeout_s);
  [[nodiscard]] Status start_watchdog();
  [[nodiscard]] bool set_level(Time time, bool open);

  ModbusCoilParameters parameters_;
  std::unique_ptr<Connection> connection_;
  std::string unconfirmed_;
  bool written_ = false;
  bool level_ = false;
  Time last_write_;
  Time next_connect_;
};

}  // namespace furrow::actuation
