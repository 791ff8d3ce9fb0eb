#pragma once

#include <memory>
#include <optional>
#include <string>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_actuation/canopen_gateway.hpp"
#include "furrow_actuation/cia402.hpp"
#include "furrow_actuation/motion_profile.hpp"
#include "furrow_core/parameters.hpp"

namespace furrow::actuation::cia402 {

struct ModbusAxisParameters {
  std::string address = "127.0.0.1";
  std::int64_t port = 502;
  std::int64_t unit = 0;
  double timeout_s = 0.02;
  double counts_per_m = 100000.0;
  double homing_speed_mps = 0.05;
  double homing_acceleration_mps2 = 0.5;
  std::int64_t homing_method = 37;
  bool has_following_error = true;

  void visit(ParameterVisitor& v);
};

/// A drive that speaks CiA 402 through a Modbus TCP gateway to its object dictionary, as the
/// dryve D1 does. Each object is one exchange on the wire, bounded by timeout_s. A lost connection
/// is kFault with kConnectionLost until reset(), which connects again; what the drive does then is
/// its own matter (set its connection watchdog to stop it).
/// A drive that does not offer cyclic positions (object 6502h) is sent to the end of the movement
/// whenever that changes, by a profile of its own within the same limits.
class ModbusAxisDriver final : public AxisDriver {
 public:
  /// Connects on the first read(). Throws ConfigError for bad limits or parameters.
  ModbusAxisDriver(const MotionLimits& limits, const ModbusAxisParameters& parameters);
  ~ModbusAxisDriver() override;
  ModbusAxisDriver(const ModbusAxisDriver&) = delete;
  ModbusAxisDriver& operator=(const ModbusAxisDriver&) = delete;

  [[nodiscard]] Status read(Time now, Duration period) override;
  [[nodiscard]] Status write(Time now, Duration period, const AxisCommand& command) override;
  [[nodiscard]] const AxisReading& reading() const override { return reading_; }
  [[nodiscard]] Status enable(Time now) override;
  [[nodiscard]] Status disable(Time now) override;
  [[nodiscard]] Status home(Time now) override;
  [[nodiscard]] Status emergency_stop(Time now) override;
  [[nodiscard]] Status reset(Time now) override;

  [[nodiscard]] std::uint16_t statusword() const { return statusword_; }

 private:
  struct Connection;

  [[nodiscard]] Status connect();
  [[nodiscard]] Status configure();
  void lose_connection();
  [[nodiscard]] Result<std::int32_t> exchange(const Telegram& request, const Object& object,
                                              bool write);
  [[nodiscard]] Result<std::int32_t> get(const Object& object);
  [[nodiscard]] Status set(const Object& object, std::int32_t value);
  [[nodiscard]] Status send_controlword(std::uint16_t word);
  [[nodiscard]] Status ensure_mode(Mode mode);
  [[nodiscard]] Status move_by_profile(double position_m);
  void interpret(Time now);
  [[nodiscard]] std::int32_t counts(double meters) const;
  [[nodiscard]] bool powered() const;

  MotionLimits limits_;
  ModbusAxisParameters parameters_;
  std::unique_ptr<Connection> connection_;
  AxisReading reading_;
  Sequencer sequencer_;
  std::uint16_t statusword_ = 0;
  std::uint16_t controlword_ = 0;
  std::int32_t mode_ = 0;
  std::optional<std::int32_t> profile_target_;  ///< where the drive is on its way to, in counts
  bool cyclic_offered_ = false;
  bool lost_ = false;
  bool emergency_stop_ = false;
  bool homing_ = false;
  bool homing_failed_ = false;
};

}  // namespace furrow::actuation::cia402
