#include "furrow_simulation/spray.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::simulation {
namespace {

constexpr double kGravity_mps2 = 9.80665;

}  // namespace

void SprayParameters::visit(ParameterVisitor& v) {
  const auto delay = [](std::string name, std::string description) {
    return ParameterInfo{.name = std::move(name),
                         .unit = "s",
                         .description = std::move(description),
                         .min = 0.0,
                         .max = 1.0};
  };
  const auto wind = [](std::string name, std::string description) {
    return ParameterInfo{.name = std::move(name),
                         .unit = "m/s",
                         .description = std::move(description),
                         .min = -5.0,
                         .max = 5.0};
  };
  v.visit(delay("open_delay_s", "True time from the command until the first drop leaves"),
          open_delay_s);
  v.visit(delay("close_delay_s", "True time from the command until the last drop leaves"),
          close_delay_s);
  v.visit(delay("delay_jitter_s", "Standard deviation of each delay"), delay_jitter_s);
  v.visit({.name = "droplet_speed_mps",
           .unit = "m/s",
           .description = "Speed at which drops leave the nozzle, downwards",
           .min = 0.0,
           .max = 100.0},
          droplet_speed_mps);
  v.visit({.name = "carry",
           .description = "Part of the nozzle's speed that drops keep while they fall",
           .min = 0.0,
           .max = 1.0},
          carry);
  v.visit(wind("drift_x_mps", "Drift of the drops by wind along the row"), drift_x_mps);
  v.visit(wind("drift_y_mps", "Drift of the drops by wind to the left"), drift_y_mps);
}

double fall_time_s(double height_m, double droplet_speed_mps) {
  if (height_m <= 0.0) return 0.0;
  // The root of h = v t + g t^2 / 2 in the form that loses no digits when v is large.
  return 2.0 * height_m /
         (droplet_speed_mps +
          std::sqrt(droplet_speed_mps * droplet_speed_mps + 2.0 * kGravity_mps2 * height_m));
}

Eigen::Vector2d landing_point(const NozzleState& nozzle, double height_m,
                              const SprayParameters& parameters) {
  const Eigen::Vector2d drift_F_mps(parameters.drift_x_mps, parameters.drift_y_mps);
  return nozzle.p_F_m + fall_time_s(height_m, parameters.droplet_speed_mps) *
                            (parameters.carry * nozzle.v_F_mps + drift_F_mps);
}

SprayPatch spray_patch(const NozzleState& at_open, const NozzleState& at_close, double height_m,
                       const SprayParameters& parameters) {
  const Eigen::Vector2d first_F = landing_point(at_open, height_m, parameters);
  const Eigen::Vector2d last_F = landing_point(at_close, height_m, parameters);
  const double half_window_s = (at_close.time - at_open.time).to_seconds() / 2;
  const double fall_s = fall_time_s(height_m, parameters.droplet_speed_mps);
  return {.time = at_open.time + Duration::seconds(half_window_s + fall_s),
          .p_F_m = (first_F + last_F) / 2,
          .sweep_F_m = last_F - first_F};
}

SimulatedValve::SimulatedValve(const SprayParameters& parameters, std::uint64_t seed,
                               std::uint64_t index)
    : parameters_(parameters), random_(seed, "valve", index) {}

std::optional<ValveWindow> SimulatedValve::actuate(Time open_command, Time close_command) {
  const double slow_s = fault_ == ValveFault::kSlow ? kSlowValve_s : 0.0;
  const auto answer = [this, slow_s](Time command, double delay_s) {
    const double late_s = delay_s + slow_s + parameters_.delay_jitter_s * random_.normal(0.0, 1.0);
    return command + Duration::seconds(std::max(late_s, 0.0));
  };
  const Time open = answer(open_command, parameters_.open_delay_s);
  const Time close = answer(close_command, parameters_.close_delay_s);
  if (fault_ == ValveFault::kStuckShut || fault_ == ValveFault::kBlocked) return std::nullopt;
  if (close <= open) return std::nullopt;
  if (fault_ == ValveFault::kStuckOpen) return ValveWindow{.open = open, .close = std::nullopt};
  return ValveWindow{.open = open, .close = close};
}

}  // namespace furrow::simulation
