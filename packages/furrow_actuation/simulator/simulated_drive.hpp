#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>

namespace furrow::actuation::drive_simulator {

/// A simulated servo drive with the object dictionary and state machine of CiA 402. It shares no
/// code with the driver that it is there to test. Positions are in counts; time moves in advance().
/// A quick stop follows its option code (605Ah: 2 removes the power once it stands, 6 stays). Its
/// connection watchdog is object 2010h, in ms, 0: off; when nothing is received for longer it acts
/// by the abort option code (6007h: 0 nothing, 1 fault, 2 power off, 3 quick stop).
class SimulatedDrive {
 public:
  SimulatedDrive();

  enum class Answer { kOk, kNoObject, kReadOnly, kBadValue };
  [[nodiscard]] std::optional<std::int32_t> read(std::uint16_t index, std::uint8_t sub) const;
  Answer write(std::uint16_t index, std::uint8_t sub, std::int32_t value);
  void advance(double seconds);
  /// A request was received: feeds the watchdog.
  void contact() { unheard_s_ = 0.0; }

  /// A fault of the drive; the cause lasts until clear_cause().
  void fault(std::uint16_t error_code);
  void clear_cause() { cause_lasts_ = false; }
  /// The reference switch is missing: homing ends with its error bit.
  void set_reference_missing(bool missing) { reference_missing_ = missing; }
  /// Drives of the simpler kind know no cyclic positions.
  void set_cyclic_offered(bool offered) { cyclic_offered_ = offered; }
  /// The axis does not follow.
  void set_jammed(bool jammed) { jammed_ = jammed; }

  enum class Phase {
    kStarting,
    kLocked,     ///< Switch On Disabled
    kPrepared,   ///< Ready To Switch On
    kPoweredOn,  ///< Switched On
    kOperating,  ///< Operation Enabled
    kQuickStop,
    kReacting,  ///< Fault Reaction Active
    kFaulted,
  };
  [[nodiscard]] Phase phase() const { return phase_; }
  /// Called with each new phase, on the thread that brought it about.
  void on_phase(std::function<void(Phase)> told) { told_ = std::move(told); }
  /// The object is not in this drive's dictionary.
  void remove_object(std::uint16_t index, std::uint8_t sub = 0) { parameters_.erase({index, sub}); }
  [[nodiscard]] bool watchdog_acted() const { return watchdog_acted_; }
  /// For tests that start from each state.
  void force_phase(Phase phase) { phase_ = phase; }
  [[nodiscard]] double position() const { return position_; }
  [[nodiscard]] double velocity() const { return velocity_; }

 private:
  void take_controlword(std::uint16_t word);
  void change_phase(std::uint16_t word, std::uint16_t before);
  void step(double h);
  void operate(double h);
  void home(double h);
  void watch_connection(double h);
  void enter(Phase phase);
  void start_action();
  void move_towards(double target, double speed, double acceleration, double h);
  void brake(double deceleration, double h);
  [[nodiscard]] std::uint16_t statusword() const;
  [[nodiscard]] double parameter(std::uint16_t index, std::uint8_t sub = 0) const;

  std::map<std::pair<std::uint16_t, std::uint8_t>, std::int32_t> parameters_;
  Phase phase_ = Phase::kStarting;
  std::uint16_t controlword_ = 0;
  std::int32_t mode_ = 0;
  std::uint16_t error_code_ = 0;
  bool cause_lasts_ = false;
  bool reference_missing_ = false;
  bool jammed_ = false;
  bool cyclic_offered_ = true;
  bool following_error_ = false;
  bool acknowledged_ = false;
  bool homing_ = false;
  bool homed_ = false;
  bool homing_error_ = false;
  double position_ = 12345.0;
  double velocity_ = 0.0;
  double demand_ = 12345.0;
  double target_ = 12345.0;
  double unsimulated_s_ = 0.0;  ///< less than a step
  double unheard_s_ = 0.0;
  bool watchdog_acted_ = false;
  std::function<void(Phase)> told_;
};

}  // namespace furrow::actuation::drive_simulator
