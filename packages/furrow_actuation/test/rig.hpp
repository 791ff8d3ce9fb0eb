#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "furrow_actuation/simulated_axis_driver.hpp"
#include "furrow_actuation/tool_loop.hpp"

namespace furrow::actuation::testing {

/// The four axes of the paper's robot.
inline geometry::AxisModel paper_axis(int index) {
  geometry::AxisModel axis;
  axis.name = "axis_" + std::to_string(index);
  axis.p_BN0 = {0.18 - 0.12 * index, 0.0, 0.6};
  axis.lower_m = -0.695;
  axis.upper_m = 0.695;
  axis.max_velocity_mps = 5.0;
  axis.max_acceleration_mps2 = 50.0;
  axis.max_jerk_mps3 = 2000.0;
  axis.nozzle.height_m = 0.6;
  axis.nozzle.footprint_radius_m = 0.025;
  return axis;
}

/// A spray as it came down: the mean of its droplets' landing points.
struct Landed {
  int axis = 0;
  Time opened;
  double seconds = 0.0;
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> droplets_F;
};

/// A valve whose connection can be cut: then no write is confirmed.
class CuttableValve final : public ValveDriver {
 public:
  explicit CuttableValve(ValveDriver& valve) : valve_(valve) {}
  Status write(Time time, bool open) override {
    if (cut) return Error{ErrorCode::kUnavailable, "cut"};
    return valve_.write(time, open);
  }
  bool cut = false;

 private:
  ValveDriver& valve_;
};

/// Drives, valves and control loops on a robot whose true motion is integrated in small steps.
/// Where droplets land follows from the history of the nozzles' positions and an integrated fall
/// alone.
class Rig {
 public:
  using Speed = std::function<Twist2(double)>;

  Rig(int axes, const AxisControllerParameters& parameters, const NozzleCalibration& calibration,
      const SimulatedValveParameters& valve, const SimulatedAxisParameters& drive, Speed speed)
      : speed_(std::move(speed)), carry_(calibration.carry) {
    double v = calibration.exit_speed_mps;
    for (double height = 0.6; height > 0.0; height -= v * 1e-5) {
      v += 9.80665e-5;
      fall_s_ += 1e-5;
    }
    for (int i = 0; i < axes; ++i) {
      axes_.push_back(
          std::make_unique<Axis>(*this, paper_axis(i), calibration, parameters, drive, valve));
    }
  }

  struct Axis {
    Axis(const Rig& rig, const geometry::AxisModel& axis, const NozzleCalibration& calibration,
         const AxisControllerParameters& parameters, const SimulatedAxisParameters& drive,
         const SimulatedValveParameters& valve_parameters)
        : model(axis),
          controller(axis, calibration, parameters),
          driver(MotionLimits::of(axis), drive),
          valve(valve_parameters, 7, axis.name),
          link(valve),
          loop(controller, driver, link, kPeriod, parameters.safety.loop_deadline_s,
               [&rig] { return rig.now(); }) {}

    geometry::AxisModel model;
    AxisController controller;
    SimulatedAxisDriver driver;
    SimulatedValve valve;
    CuttableValve link;
    ToolLoop loop;
    ControllerOutput output;
    std::vector<ControllerEvent> events;
    std::optional<Time> flowing_since;
    std::deque<Eigen::Vector2d> nozzle_F;  ///< one a cycle, the last one at now_
  };

  [[nodiscard]] Axis& axis(int i) { return *axes_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int size() const { return static_cast<int>(axes_.size()); }
  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] const BaseState& base() const { return base_; }
  [[nodiscard]] const std::vector<Landed>& landed() const { return landed_; }

  bool send_odometry = true;
  Duration odometry_clock;  ///< what the clock of the odometry is ahead
  bool send_tracks = true;
  bool send_heartbeat = true;
  std::vector<ProtectedPlant> crops;  ///< in the tracks

  /// One cycle of 2 ms. Odometry, tracks and heartbeats come every fifth cycle.
  void step() {
    for (auto& a : axes_) {
      if (cycle_ % 5 != 0) break;
      if (send_odometry) a->controller.set_odometry(now_, odometry());
      if (send_tracks) a->controller.set_protected(now_, crops);
      if (send_heartbeat) a->controller.safety().heartbeat_came(now_);
    }
    for (int i = 0; i < size(); ++i) step_axis(i);
    drive_on();
  }

  /// Cycles that a busy computer leaves out: the robot and the drives go on without control.
  void stall(int cycles) {
    for (int i = 0; i < cycles; ++i) drive_on();
  }

  static constexpr Duration kPeriod = Duration::milliseconds(2);

 private:
  [[nodiscard]] BaseState odometry() const {
    BaseState sent = base_;
    sent.stamp += odometry_clock;
    return sent;
  }

  void drive_on() {
    const int substeps = 20;
    const double h = kPeriod.to_seconds() / substeps;
    for (int k = 0; k < substeps; ++k) {
      base_.twist_B = speed_(base_.stamp.to_seconds());
      const double heading = base_.X_FB.heading_rad + h / 2.0 * base_.twist_B.yaw_rate_radps;
      base_.X_FB.x_m += h * base_.twist_B.vx_mps * std::cos(heading);
      base_.X_FB.y_m += h * base_.twist_B.vx_mps * std::sin(heading);
      base_.X_FB.heading_rad += h * base_.twist_B.yaw_rate_radps;
      base_.stamp += Duration::seconds(h);
    }
    base_.twist_B = speed_(base_.stamp.to_seconds());
    ++cycle_;
    now_ = Time::from_nanoseconds(cycle_ * kPeriod.count_ns());
    base_.stamp = now_;
  }

  void step_axis(int i) {
    Axis& a = axis(i);
    a.driver.advance(now_);
    const auto p_BN = a.model.nozzle_position_B(a.driver.reading().position_m);
    a.nozzle_F.push_back(geometry::transform(base_.X_FB, p_BN.head<2>()));
    if (a.nozzle_F.size() > 200) a.nozzle_F.pop_front();
    for (const auto& change : a.valve.take_changes(now_ - kPeriod)) {
      if (change.flowing) {
        a.flowing_since = change.time;
      } else if (a.flowing_since) {
        landed_.push_back(land(i, *a.flowing_since, change.time));
        a.flowing_since.reset();
      }
    }
    a.output = a.loop.cycle(now_).output;
    for (const auto& event : a.output.events) a.events.push_back(event);
  }

  Eigen::Vector2d nozzle_at(const Axis& a, Time time) const {
    const double back = (now_ - time).to_seconds() / kPeriod.to_seconds();
    const double place = static_cast<double>(a.nozzle_F.size()) - 1.0 - back;
    const auto low = static_cast<std::size_t>(std::max(0.0, std::floor(place)));
    const std::size_t high = std::min(low + 1, a.nozzle_F.size() - 1);
    const double share = place - static_cast<double>(low);
    return (1.0 - share) * a.nozzle_F[low] + share * a.nozzle_F[high];
  }

  Landed land(int i, Time from, Time to) const {
    const Axis& a = *axes_[static_cast<std::size_t>(i)];
    Landed out{i, from, (to - from).to_seconds(), Eigen::Vector2d::Zero(), {}};
    constexpr int kDroplets = 21;
    for (int k = 0; k < kDroplets; ++k) {
      const Time t = from + Duration::nanoseconds((to - from).count_ns() * k / (kDroplets - 1));
      const Duration h = Duration::nanoseconds(500'000);
      const Eigen::Vector2d velocity_F = (nozzle_at(a, t + h) - nozzle_at(a, t - h)) / 1e-3;
      out.droplets_F.push_back(nozzle_at(a, t) + carry_ * fall_s_ * velocity_F);
      out.p_F += out.droplets_F.back() / kDroplets;
    }
    return out;
  }

  Speed speed_;
  double carry_;
  double fall_s_ = 0.0;
  std::vector<std::unique_ptr<Axis>> axes_;
  BaseState base_;
  Time now_;
  std::int64_t cycle_ = 0;
  std::vector<Landed> landed_;
};

inline PlannedStop stop_at(std::int64_t id, const Eigen::Vector2d& p_F, Time observed,
                           Time intended = {}) {
  PlannedStop stop;
  stop.stop_id = id;
  stop.p_F = p_F;
  stop.targets.push_back(id);
  stop.observed = observed;
  stop.intended = intended;
  return stop;
}

}  // namespace furrow::actuation::testing
