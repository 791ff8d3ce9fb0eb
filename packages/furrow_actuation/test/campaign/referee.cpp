#include "referee.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::actuation::campaign {
namespace {

/// The controller keeps 30 mm between a spray's centre and a crop; prediction, localization and the
/// valve's own time may take this much of it.
constexpr double kCropDistance_m = 0.022;
/// Placement tolerance, the smear of an opening at the greatest speed, and the localization.
constexpr double kWeedDistance_m = 0.020;

}  // namespace

void Referee::reset_sent(SafetyCause cause) {
  if (cause == SafetyCause::kNone) {
    waiting_for_reset_.clear();
  } else {
    waiting_for_reset_.erase(cause);
  }
}

void Referee::note(const ControllerEvent& event) {
  switch (event.kind) {
    case ControllerEventKind::kSafeState:
      ++tally_.latched;
      waiting_for_reset_.insert(event.cause);
      break;
    case ControllerEventKind::kReset:
      ++tally_.resets;
      break;
    case ControllerEventKind::kResetRefused:
      ++tally_.refused;
      waiting_for_reset_.insert(event.cause);
      break;
    case ControllerEventKind::kStopSkipped:
      ++tally_.skipped;
      break;
    case ControllerEventKind::kSprayOpened:
      ++tally_.sprays;
      for (const std::int64_t id : event.targets) {
        if (++sprayed_[id] > 1) found_ = "target " + std::to_string(id) + " is sprayed twice";
      }
      break;
    case ControllerEventKind::kSprayClosed:
      break;
  }
}

void Referee::saw(const CycleReport& report, bool emergency_stop, bool active) {
  in_control_ = true;
  for (const ControllerEvent& event : report.output.events) note(event);
  wanted_open_ = report.output.valve_open;
  const bool running = report.output.mode == ControllerMode::kRunning;
  if (running && !waiting_for_reset_.empty()) {
    found_ = "it runs again without a reset of " +
             std::string(to_string(waiting_for_reset_.list().front()));
  }
  if (!wanted_open_) return;
  if (!running)
    found_ = "the valve is wanted open in mode " + std::string(to_string(report.output.mode));
  if (emergency_stop) found_ = "the valve is wanted open during an emergency stop";
  if (!active) found_ = "the valve of a raised tool is wanted open";
  if (world_.base().twist_B.vx_mps < 0.0) found_ = "the valve of a reversing robot is wanted open";
}

std::string Referee::judge() {
  if (!found_.empty()) return found_;
  if (hardware_.valve.trouble() != ValveTrouble::kNone) {
    trouble_until_ = world_.now() + Duration::seconds(ValveHardware::kSlow_s) + kCycle;
  }
  if (std::string flow = judge_flow(); !flow.empty()) return flow;
  return judge_motion();
}

std::string Referee::judge_flow() {
  const Time now = world_.now();
  const bool in_touch = in_control_ && valve_connected_;
  if (in_touch && wanted_open_) last_wanted_ = now;
  if (!hardware_.valve.flowing() || (trouble_until_ && now <= *trouble_until_)) return "";
  if (!last_wanted_) return "drops although the valve was never opened";
  const double since_s = (now - *last_wanted_).to_seconds();
  const double bound_s = ValveHardware::kDelay_s + 2.0 * kCycle.to_seconds();
  if (since_s <= bound_s) return judge_landing();
  // The process is dead, stopped or cut off: the module's watchdog ends the spray.
  ++tally_.overrun_cycles;
  tally_.longest_overrun_s = std::max(tally_.longest_overrun_s, since_s);
  if (since_s > ValveHardware::kWatchdog_s + bound_s) {
    return "drops " + std::to_string(since_s) + " s after the valve was last wanted open";
  }
  return "";
}

std::string Referee::judge_landing() const {
  const AxisReading& drive = hardware_.drive.reading();
  const Eigen::Vector2d p_F =
      drop_landing(world_.base(), hardware_.model, drive.position_m, drive.velocity_mps);
  double weed_m = 1e9;
  for (const TruePlant& plant : world_.plants()) {
    const double distance_m = (plant.p_F - p_F).norm();
    if (plant.crop && distance_m < kCropDistance_m) {
      return "a drop lands " + std::to_string(1e3 * distance_m) + " mm from crop " +
             std::to_string(plant.id);
    }
    if (!plant.crop) weed_m = std::min(weed_m, distance_m);
  }
  if (weed_m > kWeedDistance_m) {
    return "a drop lands " + std::to_string(1e3 * weed_m) + " mm from the nearest weed";
  }
  return "";
}

std::string Referee::judge_motion() const {
  constexpr double kRounding = 1e-6;
  const AxisReading& drive = hardware_.drive.reading();
  const geometry::AxisModel& axis = hardware_.model;
  if (!(std::abs(drive.velocity_mps) <= axis.max_velocity_mps * (1.0 + 1e-3))) {
    return "the axis moves at " + std::to_string(drive.velocity_mps) + " m/s";
  }
  if (!(drive.position_m >= axis.lower_m - kRounding &&
        drive.position_m <= axis.upper_m + kRounding)) {
    return "the axis is at " + std::to_string(drive.position_m) + " m";
  }
  return "";
}

}  // namespace furrow::actuation::campaign
