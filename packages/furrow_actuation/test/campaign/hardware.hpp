#pragma once

#include <optional>

#include "furrow_actuation/nozzle.hpp"
#include "furrow_actuation/simulated_axis_driver.hpp"
#include "world.hpp"

namespace furrow::actuation::campaign {

enum class ValveTrouble { kNone, kStuckOpen, kStuckShut, kSlow, kBlocked, kLeaking };

/// The output module of one valve with its watchdog, and the valve behind it: what stays when the
/// driver's process dies.
class ValveHardware {
 public:
  static constexpr double kWatchdog_s = 0.3;
  static constexpr double kDelay_s = 0.004;
  static constexpr double kSlow_s = 0.060;

  void set_connected(bool connected) { connected_ = connected; }
  void set_trouble(ValveTrouble trouble) { trouble_ = trouble; }
  [[nodiscard]] ValveTrouble trouble() const { return trouble_; }

  /// A request of the driver; false: it is not answered, and did not arrive.
  bool request(Time now, bool open);
  /// To be called each cycle: the watchdog, and the valve's delay.
  void advance(Time now);
  /// Drops leave the nozzle.
  [[nodiscard]] bool flowing() const;
  /// The level at the module's output, and since when.
  [[nodiscard]] bool coil() const { return coil_; }
  [[nodiscard]] Time coil_since() const { return coil_since_; }

 private:
  void set_coil(Time now, bool open);

  bool connected_ = true;
  ValveTrouble trouble_ = ValveTrouble::kNone;
  bool coil_ = false;
  Time coil_since_;
  std::optional<Time> last_request_;
  bool flow_ = false;
};

/// The driver's end: as ModbusCoilValve, it writes on change and to refresh.
class ValveClient final : public ValveDriver {
 public:
  explicit ValveClient(ValveHardware& hardware) : hardware_(hardware) {}
  Status write(Time time, bool open) override;

 private:
  static constexpr double kRefresh_s = 0.1;
  ValveHardware& hardware_;
  std::optional<Time> written_;
  bool level_ = false;
};

/// What belongs to one tool and outlives its process.
struct ToolHardware {
  explicit ToolHardware(int index)
      : model(axis_model(index)),
        drive(MotionLimits::of(model), {.lag_s = 0.002, .start_ready = true, .watchdog_s = 0.1}) {}
  geometry::AxisModel model;
  SimulatedAxisDriver drive;
  ValveHardware valve;
};

}  // namespace furrow::actuation::campaign
