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
  double timeout_s = 0.01;
  double refresh_s = 0.1;
  double reconnect_s = 0.5;

  void visit(ParameterVisitor& v);
};

/// A valve at a coil of a Modbus TCP output module. The level is written when it changes, and again
/// every refresh_s, so that the module's own watchdog, which must be set to shut its outputs, is
/// fed. Connects at the first write and again after reconnect_s.
class ModbusCoilValve final : public ValveDriver {
 public:
  /// Throws ConfigError for an address or numbers that are not usable.
  explicit ModbusCoilValve(const ModbusCoilParameters& parameters);
  /// Shuts the valve, if the module answers.
  ~ModbusCoilValve() override;
  ModbusCoilValve(const ModbusCoilValve&) = delete;
  ModbusCoilValve& operator=(const ModbusCoilValve&) = delete;

  /// Blocks for timeout_s at most. kUnavailable: the module does not answer.
  Status write(Time time, bool open) override;

 private:
  struct Connection;
  [[nodiscard]] Status connect(Time time);

  ModbusCoilParameters parameters_;
  std::unique_ptr<Connection> connection_;
  bool written_ = false;
  bool level_ = false;
  Time last_write_;
  Time next_connect_;
};

}  // namespace furrow::actuation
