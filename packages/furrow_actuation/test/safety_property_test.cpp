#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "furrow_core/random.hpp"
#include "rig.hpp"

namespace furrow::actuation {
namespace {

using testing::Rig;
using testing::stop_at;

/// A robot that starts, stops, reverses and turns at random, with at most 1 m/s2.
class Wanderer {
 public:
  explicit Wanderer(std::uint64_t seed) : random_(seed, "robot") {}
  Twist2 operator()(double t) {
    const double dt = std::max(0.0, t - last_);
    last_ = t;
    if (t >= until_) {
      until_ = t + random_.uniform(0.2, 1.0);
      target_ = random_.bernoulli(0.15) ? 0.0 : random_.uniform(-0.2, 1.0);
      turn_ = random_.uniform(-0.1, 0.1);
    }
    twist_.vx_mps += std::clamp(target_ - twist_.vx_mps, -dt, dt);
    twist_.yaw_rate_radps += std::clamp(turn_ - twist_.yaw_rate_radps, -0.3 * dt, 0.3 * dt);
    return twist_;
  }

 private:
  Random random_;
  Twist2 twist_{0.5, 0.0, 0.0};
  double last_ = 0.0;
  double until_ = 0.0;
  double target_ = 0.5;
  double turn_ = 0.0;
};

struct Totals {
  int sprays = 0;
  int safe = 0;
  int skipped = 0;
  int protected_crop = 0;
};

class Ordeal {
 public:
  explicit Ordeal(std::uint64_t seed)
      : random_(seed, "ordeal"),
        rig_(1, parameters_of(seed), {}, {}, drive_of(seed), Wanderer(seed)) {
    for (int i = 0; i < 25; ++i) {
      crops_.push_back({i, {random_.uniform(0.2, 3.0), random_.uniform(-0.6, 0.6)}});
    }
    rig_.crops = crops_;
    for (int i = 0; i < 40; ++i) {
      auto stop = stop_at(100 + i, {random_.uniform(0.2, 3.0), random_.uniform(-0.8, 0.8)}, {});
      if (random_.bernoulli(0.3)) {  // right beside a crop
        stop.p_F = crops_[static_cast<std::size_t>(random_.integer(0, 24))].p_F +
                   Eigen::Vector2d(random_.uniform(-0.05, 0.05), random_.uniform(-0.05, 0.05));
      }
      stop.fire_while_moving = random_.bernoulli(0.3);
      stops_.push_back(stop);
    }
    std::sort(stops_.begin(), stops_.end(),
              [](const auto& a, const auto& b) { return a.p_F.x() < b.p_F.x(); });
  }

  void run(Totals& totals) {
    for (int cycle = 0; cycle < 1500; ++cycle) {
      if (send_plan_ && cycle % 50 == 0) send_plan();
      if (random_.bernoulli(0.01)) meddle();
      if (rig_.send_odometry) odometry_ = rig_.now();
      rig_.step();
      check_cycle();
      if (::testing::Test::HasFatalFailure()) return;
    }
    check_sprays(totals);
  }

 private:
  static AxisControllerParameters parameters_of(std::uint64_t seed) {
    AxisControllerParameters parameters;
    parameters.dwell_s = seed % 3 == 0 ? 0.030 : 0.010;
    return parameters;
  }
  static SimulatedAxisParameters drive_of(std::uint64_t seed) {
    SimulatedAxisParameters drive;
    drive.start_ready = true;
    drive.lag_s = seed % 2 == 0 ? 0.0 : 0.003;
    drive.start_position_m = 0.1 * static_cast<double>(seed % 7) - 0.3;
    return drive;
  }

  AxisController& controller() { return rig_.axis(0).controller; }
  SimulatedAxisDriver& driver() { return rig_.axis(0).driver; }

  void send_plan() {
    std::vector<PlannedStop> some;
    for (auto stop : stops_) {
      if (random_.bernoulli(0.2)) continue;
      stop.observed = rig_.now();
      some.push_back(stop);
    }
    if (random_.bernoulli(0.1)) std::reverse(some.begin(), some.end());
    planned_ = rig_.now();
    ASSERT_TRUE(controller().set_plan(rig_.now(), some).ok());
  }

  void meddle() {
    const Time now = rig_.now();
    switch (random_.integer(0, 15)) {
      case 0:
        emergency_stop_ = random_.bernoulli(0.3);
        controller().safety().set_emergency_stop(emergency_stop_);
        break;
      case 1:
        rig_.send_heartbeat = random_.bernoulli(0.8);
        break;
      case 2:
        driver().inject(now, random_.bernoulli(0.5) ? DriveFault::kDrive : DriveFault::kNone);
        break;
      case 3:
        driver().set_connected(now, random_.bernoulli(0.7));
        break;
      case 4:
        rig_.send_odometry = random_.bernoulli(0.7);
        break;
      case 5:
        send_plan_ = random_.bernoulli(0.8);
        break;
      case 6:
        dry_run_ = random_.bernoulli(0.2);
        controller().set_dry_run(dry_run_);
        break;
      case 7:
        driver().set_jammed(random_.bernoulli(0.3));
        break;
      case 8:
        if (random_.bernoulli(0.2)) (void)driver().emergency_stop(now).ok();
        break;
      case 9:
        rig_.axis(0).link.cut = random_.bernoulli(0.3);
        break;
      case 10:
        rig_.send_tracks = random_.bernoulli(0.7);
        break;
      case 11:
        controller().safety().set_active(random_.bernoulli(0.7));
        break;
      default:  // the operator sets everything right
        driver().set_connected(now, true);
        driver().set_jammed(false);
        driver().clear_faults();
        rig_.axis(0).link.cut = false;
        rig_.send_odometry = true;
        rig_.send_tracks = true;
        rig_.send_heartbeat = true;
        send_plan_ = true;
        controller().safety().set_active(true);
        rig_.axis(0).loop.request_reset(now, SafetyCause::kNone);
        break;
    }
  }

  void check_cycle() {
    const auto& axis = rig_.axis(0);
    const auto limits = MotionLimits::of(axis.model);
    const MotionState s = axis.controller.setpoint();
    ASSERT_LE(s.position_m, limits.upper_m + 1e-6);
    ASSERT_GE(s.position_m, limits.lower_m - 1e-6);
    ASSERT_LE(std::abs(s.velocity_mps), limits.max_velocity_mps + 1e-6);
    ASSERT_LE(std::abs(s.acceleration_mps2), limits.max_acceleration_mps2 + 1e-6);
    const AxisReading& drive = axis.driver.reading();
    const double h = Rig::kPeriod.to_seconds();
    const bool heard = drive.stamp + Rig::kPeriod == rig_.now() &&
                       (before_ == AxisState::kReady || before_ == AxisState::kMoving);
    const bool running = axis.output.mode == ControllerMode::kRunning;
    if (heard && running && was_running_) {
      // What the drive is asked for, from where its setpoint stood when it was read.
      const double v = (axis.output.axis.position_m - last_command_m_) / h;
      ASSERT_LE(std::abs(v), limits.max_velocity_mps + 1e-6);
      if (had_velocity_) {
        ASSERT_LE(std::abs(v - last_v_) / h, limits.max_acceleration_mps2 + 1e-3);
      }
      last_v_ = v;
    }
    had_velocity_ = heard && running && was_running_;
    was_running_ = running && axis.output.events.empty();
    last_command_m_ = axis.output.axis.position_m;
    before_ = drive.state;
    ASSERT_LE(std::abs(axis.driver.reading().position_m), 0.695 + 1e-6);

    if (!axis.output.valve_open) {
      open_cycles_ = 0;
      return;
    }
    ASSERT_EQ(axis.output.mode, ControllerMode::kRunning);
    ASSERT_FALSE(emergency_stop_);
    ASSERT_FALSE(dry_run_ && open_cycles_ == 0);
    const AxisControllerParameters deadlines;
    ASSERT_LE((rig_.now() - planned_).to_seconds(), deadlines.safety.plan_deadline_s + 2 * h);
    ASSERT_LE((rig_.now() - odometry_).to_seconds(), deadlines.safety.odometry_deadline_s + 2 * h);
    ASSERT_GT(rig_.base().twist_B.vx_mps, 0.0);
    ASSERT_LE(++open_cycles_, 16);  // dwell, in cycles of 2 ms, and one more
  }

  void check_sprays(Totals& totals) {
    const auto& axis = rig_.axis(0);
    std::map<std::int64_t, int> outcomes;
    int opened = 0;
    for (const auto& event : axis.events) {
      if (event.kind == ControllerEventKind::kSprayOpened) {
        ++outcomes[event.stop_id];
        if (!event.dry_run) ++opened;
      }
      if (event.kind == ControllerEventKind::kStopSkipped) {
        ++outcomes[event.stop_id];
        ++totals.skipped;
        if (event.reason == SkipReason::kProtectedCrop) ++totals.protected_crop;
      }
      if (event.kind == ControllerEventKind::kSafeState) ++totals.safe;
    }
    for (const auto& [stop, count] : outcomes) EXPECT_EQ(count, 1) << "stop " << stop;
    EXPECT_LE(rig_.landed().size(), static_cast<std::size_t>(opened));
    for (const auto& landed : rig_.landed()) {
      ++totals.sprays;
      for (const auto& droplet_F : landed.droplets_F) {
        for (const auto& crop : crops_) {
          EXPECT_GE((droplet_F - crop.p_F).norm(), 0.025) << "axis sprayed a protected plant";
        }
      }
    }
  }

  Random random_;
  Rig rig_;
  std::vector<ProtectedPlant> crops_;
  std::vector<PlannedStop> stops_;
  bool send_plan_ = true;
  Time planned_;
  Time odometry_;
  bool emergency_stop_ = false;
  bool dry_run_ = false;
  AxisState before_ = AxisState::kDisabled;
  bool was_running_ = false;
  bool had_velocity_ = false;
  double last_command_m_ = 0.0;
  double last_v_ = 0.0;
  int open_cycles_ = 0;
};

TEST(Safety, HoldsForRandomPlansFaultsAndCommands) {
  Totals totals;
  for (std::uint64_t seed = 0; seed < 700; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Ordeal(seed).run(totals);
    if (HasFailure()) break;
  }
  RecordProperty("sprays", totals.sprays);
  RecordProperty("made_safe", totals.safe);
  EXPECT_GT(totals.sprays, 600);
  EXPECT_GT(totals.safe, 600);
  EXPECT_GT(totals.protected_crop, 100);
  EXPECT_GT(totals.skipped, 5000);
}

}  // namespace
}  // namespace furrow::actuation
