#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "furrow_actuation/axis_controller_types.hpp"
#include "furrow_actuation/crossing.hpp"
#include "furrow_actuation/motion_profile.hpp"
#include "furrow_actuation/nozzle.hpp"
#include "furrow_geometry/tool_model.hpp"

namespace furrow::actuation {

/// The control of one axis and its nozzle: takes the newest plan, odometry and drive reading, and
/// says each cycle where the axis shall be and whether the valve is open. Called from one thread;
/// allocates nothing after construction. Times are of one clock.
class AxisController {
 public:
  /// Throws ConfigError for limits that are not positive or a nozzle without height or footprint.
  AxisController(const geometry::AxisModel& axis, const NozzleCalibration& calibration,
                 const AxisControllerParameters& parameters);

  /// Replaces the route, ordered by `intended`. Targets that were sprayed or given up are passed
  /// over. Fails with kOutOfRange (more than kMaxPlanStops: the first ones are taken) and with
  /// kInvalidArgument (a position that is not finite, no targets: those stops are left out). An
  /// empty plan is a valid one.
  Status set_plan(Time stamp, std::span<const PlannedStop> stops);
  void set_odometry(const BaseState& base);
  /// All protected plants near the tool, from the newest tracks. More than kMaxProtectedPlants, or
  /// one that is not finite, makes the tool safe at the next update.
  void set_protected(std::span<const ProtectedPlant> plants);
  void set_reading(const AxisReading& reading);
  /// While true, the tool is safe; released, it still waits for reset().
  void set_emergency_stop(bool pressed) { emergency_stop_ = pressed; }
  void set_peer_lost(bool lost) { peer_lost_ = lost; }
  void set_valve_fault(bool fault) { valve_fault_ = fault; }
  void set_dry_run(bool dry_run) { parameters_.dry_run = dry_run; }
  void set_calibration(const NozzleCalibration& calibration);
  /// Leaves kSafe for kWaiting once the axis has stopped; a cause that is still there makes the
  /// tool safe again at once.
  void reset() { reset_requested_ = true; }

  /// One cycle at `now`; the axis command is the setpoint for now + period. @pre period > 0.
  [[nodiscard]] ControllerOutput update(Time now, Duration period);

  /// The setpoint at the last update.
  [[nodiscard]] const MotionState& setpoint() const { return setpoint_; }
  [[nodiscard]] NozzleUse use(Time now) const { return meter_.use(now); }

 private:
  struct Spray {
    PlannedStop stop;
    Time emission;      ///< middle of the spray at the nozzle
    Time close;         ///< command
    Time emission_end;  ///< the axis stays until then
    bool open = true;
    bool passing = false;
    bool dry_run = false;
  };
  struct Aim {
    Crossing crossing;
    ValveWindow window;
    double q_m = 0.0;        ///< crossing.q_m, brought inside the limits
    bool reachable = false;  ///< crossing.q_m is inside, but for the placement tolerance
  };
  struct Landing {
    Eigen::Vector2d first_F;
    Eigen::Vector2d middle_F;
    Eigen::Vector2d last_F;
    double q_velocity_mps = 0.0;
  };

  // Safety.
  [[nodiscard]] SafetyCause find_cause(Time now) const;
  [[nodiscard]] SafetyCause find_running_cause(Time now) const;
  [[nodiscard]] bool everything_there(Time now) const;
  void track_following_error(Time now);
  void make_safe(Time now, SafetyCause cause);
  void give_up_due_stops(Time now);

  // Route.
  void run(Time now, Duration period);
  void approach(Time now, Duration period);
  /// True when the stop is done with, and the next one's turn comes.
  bool approach_stop(std::size_t index, Time now, Duration period);
  [[nodiscard]] std::optional<Aim> aim_at(const PlannedStop& stop) const;
  [[nodiscard]] bool try_passing(std::size_t index, const Aim& aim, Time now, Duration period);
  /// True when the stop is sprayed or given up.
  bool fire_when_due(const PlannedStop& stop, const Aim& aim, bool passing, Time now,
                     Duration period);
  void supervise_spray(Time now, Duration period);
  void close_spray(Time now, SkipReason reason);
  [[nodiscard]] Landing predict_landing(Time middle) const;
  [[nodiscard]] bool protects(const Landing& landing) const;

  // Motion.
  [[nodiscard]] MotionState motion_at(Time time) const;
  /// The drive may have moved or stopped by itself: go on from where it holds.
  void adopt_drive_setpoint(Time now);
  /// Without setpoints for some periods the drive has begun to stop: brake with it, and go on from
  /// there, instead of asking it to jump to where it would be by now.
  void follow_drive_after_gap(Time now, Duration period);
  void move_to(double q_m, Time now);
  /// On to the same target with the axis' full limits.
  void hurry(Time now);
  [[nodiscard]] double arrival_s(double q_m, Time now) const;

  void finish(const PlannedStop& stop);
  [[nodiscard]] bool finished(const PlannedStop& stop) const;
  void skip(const PlannedStop& stop, SkipReason reason, Time now);
  [[nodiscard]] bool events_full() const;

  geometry::AxisModel model_;
  geometry::AxisModel axis_;  ///< model_, shifted by the calibrated offset
  MotionLimits limits_;
  NozzleCalibration calibration_;
  DropletModel droplet_;
  AxisControllerParameters parameters_;

  BoundedVector<PlannedStop, kMaxPlanStops> plan_;
  std::size_t next_stop_ = 0;
  std::optional<Time> plan_stamp_;
  std::optional<BaseState> base_;
  std::optional<AxisReading> reading_;
  BoundedVector<ProtectedPlant, kMaxProtectedPlants> protected_;
  bool odometry_valid_ = true;
  bool protection_valid_ = true;
  bool emergency_stop_ = false;
  bool peer_lost_ = false;
  bool valve_fault_ = false;
  bool reset_requested_ = false;

  ControllerMode mode_ = ControllerMode::kWaiting;
  SafetyCause cause_ = SafetyCause::kNone;
  Time cause_time_;
  std::optional<Time> following_error_since_;

  std::optional<Time> last_update_;
  MotionProfile profile_;
  Time profile_start_;
  MotionState setpoint_;
  std::optional<PlannedStop> passing_;  ///< departed towards the stop after it
  std::optional<Spray> spray_;
  std::optional<Time> last_close_;
  std::array<std::int64_t, 256> finished_{};
  std::size_t finished_count_ = 0;
  NozzleUseMeter meter_;
  ControllerEvents events_;
};

}  // namespace furrow::actuation
