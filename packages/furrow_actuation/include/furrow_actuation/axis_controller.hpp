#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "furrow_actuation/axis_controller_types.hpp"
#include "furrow_actuation/crossing.hpp"
#include "furrow_actuation/ground_progress.hpp"
#include "furrow_actuation/motion_profile.hpp"
#include "furrow_actuation/nozzle.hpp"
#include "furrow_actuation/tool_safety.hpp"
#include "furrow_geometry/tool_model.hpp"

namespace furrow::actuation {

/// The control of one axis and its nozzle. It takes the newest plan, odometry and drive reading,
/// and gives each cycle the axis' setpoint and the valve's level, as far as its ToolSafety permits.
/// Called from one thread; allocates nothing after construction. Times are of one clock.
class AxisController {
 public:
  /// Throws ConfigError for limits that are not positive or a nozzle without height or footprint.
  AxisController(const geometry::AxisModel& axis, const NozzleCalibration& calibration,
                 const AxisControllerParameters& parameters);

  /// The owner of the tool's safety. Inputs that the controller does not see itself are told to it
  /// directly: heartbeat, valve, emergency stop, tool/enable, resets.
  [[nodiscard]] ToolSafety& safety() { return safety_; }
  [[nodiscard]] const ToolSafety& safety() const { return safety_; }

  /// Replaces the route, ordered by `intended`. `now` is when the plan came. Targets that were
  /// sprayed or given up are passed over. Fails with kOutOfRange (more than kMaxPlanStops: the
  /// first ones are taken) and with kInvalidArgument (a position that is not finite, no targets:
  /// those stops are left out). An empty plan is a valid one.
  Status set_plan(Time now, std::span<const PlannedStop> stops);
  /// `arrival` is when the message came. Returns whether it is used: odometry that is not finite,
  /// not newer than the last, or beyond ToolSafetyParameters::odometry_delay_limit_s is left out.
  bool set_odometry(Time arrival, const BaseState& base);
  /// All protected plants near the tool, from the newest tracks; `newest_image` is when those saw
  /// the field. More than kMaxProtectedPlants, or one that is not finite, is a cause for the safe
  /// state.
  void set_protected(Time newest_image, std::span<const ProtectedPlant> plants);
  /// The drive's reading of this cycle.
  void set_reading(Time now, const AxisReading& reading);
  void set_dry_run(bool dry_run) { parameters_.dry_run = dry_run; }
  void set_calibration(const NozzleCalibration& calibration);

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
  void obey_safety(Time now);
  [[nodiscard]] bool seen_moving(Time now) const;
  void stop_motion(Time now, SkipReason reason);
  void report_safety_events();
  void give_up_due_stops(Time now, SkipReason reason);
  [[nodiscard]] AxisCommand axis_command(Time now, Duration period);

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
  /// Measured minus commanded, when the drive was last read.
  [[nodiscard]] double off_setpoint_m() const;
  /// The axis rests at its setpoint when drops leave from `first` on.
  [[nodiscard]] bool at_rest(Time first) const;
  [[nodiscard]] Landing predict_landing(Time middle) const;
  [[nodiscard]] bool protects(const Landing& landing) const;

  // Motion.
  [[nodiscard]] MotionState motion_at(Time time) const;
  /// The drive may have moved or stopped by itself: go on from where it holds.
  void adopt_drive_setpoint(Time now);
  /// Without setpoints for some periods the drive has begun to stop. Brake with it and go on from
  /// there: it cannot jump to where the old profile would be by now.
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
  std::optional<BaseState> base_;
  std::optional<AxisReading> reading_;
  BoundedVector<ProtectedPlant, kMaxProtectedPlants> protected_;
  ToolSafety safety_;
  GroundProgress progress_;
  ControllerMode mode_ = ControllerMode::kWaiting;  ///< that was obeyed last

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
