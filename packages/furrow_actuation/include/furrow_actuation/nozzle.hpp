#pragma once

#include <cstdint>
#include <string>

#include "furrow_actuation/bounded_vector.hpp"
#include "furrow_actuation/crossing.hpp"
#include "furrow_core/parameters.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation {

/// What was measured of one nozzle and its valve.
struct NozzleCalibration {
  double open_delay_s = 0.004;   ///< command to first droplets
  double close_delay_s = 0.004;  ///< command to last droplets
  double exit_speed_mps = 10.0;
  double carry = 1.0;
  double offset_x_m = 0.0;  ///< where a spray lands beside the computed point, in B
  double offset_y_m = 0.0;
  double flow_mlps = 5.0;

  void visit(ParameterVisitor& v);
  [[nodiscard]] DropletModel droplet(double height_m) const;
};

/// The times of the two commands to a valve.
struct ValveWindow {
  Time open_command;
  Time close_command;
};

/// The commands for droplets that leave for `dwell_s`, centred on `emission`, so that the middle of
/// the spray lands on the target. The commands are at least 1 ns apart.
[[nodiscard]] ValveWindow valve_window(Time emission, double dwell_s,
                                       const NozzleCalibration& calibration);

/// What a nozzle has used since the start.
struct NozzleUse {
  std::int64_t openings = 0;
  double open_s = 0.0;
  double volume_ml = 0.0;  ///< estimated: open seconds times the calibrated flow
};

/// Counts openings and open time from the level of the valve's command.
class NozzleUseMeter {
 public:
  explicit NozzleUseMeter(double flow_mlps) : flow_mlps_(flow_mlps) {}
  /// The level from `time` on. Times do not decrease.
  void command(Time time, bool open);
  /// Up to `time`, a window still open included.
  [[nodiscard]] NozzleUse use(Time time) const;

 private:
  double flow_mlps_;
  NozzleUse closed_use_;
  bool open_ = false;
  Time opened_;
};

/// A valve, written once a cycle by the loop that owns it.
class ValveDriver {
 public:
  virtual ~ValveDriver() = default;
  /// The wanted level from `time` on; success means that the device confirmed it. kUnavailable: not
  /// confirmed, the level is not known. After a lost connection the valve is shut first, and an
  /// opening fails.
  virtual Status write(Time time, bool open) = 0;
  /// What of the device's own protections is not confirmed to be in force, for people; empty: all
  /// of it is. Valid until the next call.
  [[nodiscard]] virtual std::string_view unconfirmed() const { return {}; }
};

enum class ValveFault { kNone, kStuckOpen, kStuckClosed, kBlocked };
[[nodiscard]] std::string_view to_string(ValveFault fault);

struct SimulatedValveParameters {
  double open_delay_s = 0.004;
  double close_delay_s = 0.004;
  double jitter_s = 0.0;  ///< standard deviation of each delay

  void visit(ParameterVisitor& v);
};

/// A simulated valve: follows its commands after a delay with seeded jitter. Flow changes keep the
/// order of their commands; each has its exact time, independent of the cycle.
class SimulatedValve final : public ValveDriver {
 public:
  /// Throws ConfigError when a delay or the jitter is negative.
  SimulatedValve(const SimulatedValveParameters& parameters, std::uint64_t seed,
                 std::string_view name);

  Status write(Time time, bool open) override;

  /// kStuckOpen flows from `time` on whatever is commanded; kStuckClosed and kBlocked do not flow.
  void inject(Time time, ValveFault fault);
  [[nodiscard]] ValveFault fault() const { return fault_; }

  struct FlowChange {
    Time time;
    bool flowing = false;
  };
  static constexpr std::size_t kMaxPending = 16;
  /// The changes of flow up to and including `time`, oldest first; each is given once.
  [[nodiscard]] BoundedVector<FlowChange, kMaxPending> take_changes(Time time);
  /// At the last time given to take_changes().
  [[nodiscard]] bool flowing() const { return flowing_; }

 private:
  void schedule(Time time, bool flowing);

  SimulatedValveParameters parameters_;
  Random random_;
  ValveFault fault_ = ValveFault::kNone;
  bool commanded_ = false;
  bool flowing_ = false;
  bool last_scheduled_ = false;
  BoundedVector<FlowChange, kMaxPending> pending_;
};

}  // namespace furrow::actuation
