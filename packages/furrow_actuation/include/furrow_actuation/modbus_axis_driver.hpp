#pragma once

#include <memory>
#include <optional>
#include <string>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_actuation/call_budget.hpp"
#include "furrow_actuation/canopen_gateway.hpp"
#include "furrow_actuation/cia402.hpp"
#include "furrow_actuation/motion_profile.hpp"
#include "furrow_core/parameters.hpp"

namespace furrow::actuation::cia402 {

struct ModbusAxisParameters {
  std::string address = "127.0.0.1";
  std::int64_t port = 502;
  std::int64_t unit = 0;
  double timeout_s = 0.008;
  double counts_per_m = 100000.0;
  double homing_speed_mps = 0.05;
  double homing_acceleration_mps2 = 0.5;
  std::int64_t homing_method = 37;
  bool has_following_error = true;
  std::int64_t watchdog_index = 0;
  std::int64_t watchdog_sub_index = 0;
  std::int64_t watchdog_bytes = 2;
  double watchdog_s = 0.1;
  double watchdog_unit_s = 0.001;

  void visit(ParameterVisitor& v);
};

class GatewayConnection;

/// A drive that speaks CiA 402 through a Modbus TCP gateway to its object dictionary, as the
/// dryve D1 does. Each object is one exchange; the exchanges of one call together block for
/// timeout_s at most, those of a call that connects for kConnectTimeouts times that. A lost
/// connection is kFault with kConnectionLost until reset(), which connects again; emergency_stop()
/// connects again too, to stop the drive and to see that it stands.
/// At each connection the driver sets what the drive does without it, where the object dictionary
/// offers it. A quick stop uses its own ramp and removes the power (605Ah = 2, 6085h). A fault does
/// the same (605Eh = 2). A lost connection is a quick stop (6007h = 3), found by the watchdog.
/// What the driver reads back is compared; unconfirmed() names what is missing.
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

  [[nodiscard]] std::string_view unconfirmed() const override { return unconfirmed_; }

  [[nodiscard]] std::uint16_t statusword() const { return statusword_; }

  static constexpr double kConnectTimeouts = 10.0;

 private:
  [[nodiscard]] Status connect();
  [[nodiscard]] Status configure();
  [[nodiscard]] Status configure_protection();
  [[nodiscard]] Status protect(const Object& object, std::int32_t value, std::string_view what);
  [[nodiscard]] Status read_objects();
  void lose_connection();
  void start_budget(double timeouts = 1.0);
  [[nodiscard]] Result<std::int32_t> exchange(const Telegram& request, const Object& object,
                                              bool write);
  [[nodiscard]] Result<std::int32_t> get(const Object& object);
  [[nodiscard]] Status set(const Object& object, std::int32_t value);
  [[nodiscard]] Status send_controlword(std::uint16_t word);
  [[nodiscard]] Status ensure_mode(Mode mode);
  [[nodiscard]] Status move_by_profile(double position_m);
  void interpret(Time now);
  void interpret_homing(State state);
  [[nodiscard]] AxisState axis_state(std::optional<State> state) const;
  [[nodiscard]] Status write_cyclic(double position_m);
  [[nodiscard]] std::int32_t counts(double meters) const;
  [[nodiscard]] bool operating() const;

  MotionLimits limits_;
  ModbusAxisParameters parameters_;
  std::unique_ptr<GatewayConnection> connection_;
  std::optional<CallBudget> budget_;  ///< of the call at hand
  Time next_reconnect_;               ///< of emergency_stop()
  std::string unconfirmed_ = "drive: not connected yet";
  AxisReading reading_;
  Sequencer sequencer_;
  std::uint16_t statusword_ = 0;
  std::uint16_t controlword_ = 0;
  std::int32_t mode_ = 0;
  std::optional<std::int32_t> profile_target_;  ///< where the drive is on its way to, in counts
  bool cyclic_offered_ = false;
  bool lost_ = false;
  bool emergency_stop_ = false;
  bool power_off_when_standing_ = false;
  bool homing_ = false;
  bool homing_failed_ = false;
};

}  // namespace furrow::actuation::cia402
