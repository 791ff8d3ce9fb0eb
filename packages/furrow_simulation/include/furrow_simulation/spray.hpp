#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "furrow_core/parameters.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"

namespace furrow::simulation {

/// The true physics of a nozzle, which the controller knows only by calibration.
struct SprayParameters {
  double open_delay_s = 0.008;   ///< from the command to the first drop leaving the nozzle
  double close_delay_s = 0.008;  ///< from the command to the last
  double delay_jitter_s = 0.0;   ///< standard deviation of each delay
  double droplet_speed_mps = 12.0;
  double carry = 1.0;
  double drift_x_mps = 0.0;
  double drift_y_mps = 0.0;
  void visit(ParameterVisitor& v);
};

/// A nozzle over the ground at one instant, in F.
struct NozzleState {
  Time time;
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d v_F_mps = Eigen::Vector2d::Zero();  ///< base and axis together
};

/// What one opening leaves on the ground: a disc drawn along `sweep_F_m`, centred on p_F_m.
struct SprayPatch {
  Time time;  ///< the centre reaches the ground
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d sweep_F_m = Eigen::Vector2d::Zero();  ///< from the first drop to the last
};

/// Time for a drop that leaves straight down at `droplet_speed_mps` to fall by `height_m` under
/// gravity without drag: h = v t + g t^2 / 2. @pre height_m >= 0, droplet_speed_mps >= 0.
[[nodiscard]] double fall_time_s(double height_m, double droplet_speed_mps);

/// Where drops land that leave at `nozzle`: they keep `carry` of its velocity, and the wind's drift
/// adds, for the time they fall.
[[nodiscard]] Eigen::Vector2d landing_point(const NozzleState& nozzle, double height_m,
                                            const SprayParameters& parameters);

/// What lands between the first and the last drop; the centre is midway.
[[nodiscard]] SprayPatch spray_patch(const NozzleState& at_open, const NozzleState& at_close,
                                     double height_m, const SprayParameters& parameters);

enum class ValveFault : std::uint8_t {
  kNone,
  kStuckShut,  ///< does not open
  kStuckOpen,  ///< once open, does not close
  kBlocked,    ///< moves, but nothing comes out
  kSlow,       ///< opens and shuts kSlowValve_s later
  kLeaking,    ///< drops leave at all times
};
inline constexpr double kSlowValve_s = 0.050;

/// When drops leave the nozzle. `close` is absent while the valve is stuck open. What a leaking
/// valve loses between its openings is not in it.
struct ValveWindow {
  Time open;
  std::optional<Time> close;
};

/// One valve with its delays, jitter and faults.
class SimulatedValve {
 public:
  /// `index` tells the valves of one seed apart.
  SimulatedValve(const SprayParameters& parameters, std::uint64_t seed, std::uint64_t index);

  void set_fault(ValveFault fault) { fault_ = fault; }
  [[nodiscard]] ValveFault fault() const { return fault_; }

  /// The answer to commands to open and to close; nothing when no drop leaves: a fault, or a
  /// command too short for the delays. Delays never fall below zero. Draws the same random numbers
  /// whatever the fault.
  [[nodiscard]] std::optional<ValveWindow> actuate(Time open_command, Time close_command);

 private:
  SprayParameters parameters_;
  Random random_;
  ValveFault fault_ = ValveFault::kNone;
};

}  // namespace furrow::simulation
