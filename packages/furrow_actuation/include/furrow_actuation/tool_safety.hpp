#pragma once

#include <array>
#include <optional>

#include "furrow_actuation/axis_driver.hpp"
#include "furrow_actuation/bounded_vector.hpp"
#include "furrow_actuation/safety_rules.hpp"
#include "furrow_core/parameters.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation {

/// The deadline of each input, and the limits of what the drive measures.
struct ToolSafetyParameters {
  double plan_deadline_s = 2.0;
  double tracks_deadline_s = 2.0;
  double odometry_deadline_s = 0.10;
  double odometry_delay_limit_s = 0.02;
  double heartbeat_deadline_s = 0.07;
  double reading_deadline_s = 0.02;
  double valve_deadline_s = 0.02;
  double loop_deadline_s = 0.20;
  double following_error_limit_m = 0.03;
  double following_error_time_s = 0.02;
  double position_margin_m = 0.002;

  void visit(ParameterVisitor& v);
};

enum class ControllerMode : std::uint8_t {
  kWaiting,   ///< an input or a ready drive is missing since the start or the last reset
  kRunning,   ///< the only mode in which a valve opens
  kSafe,      ///< the safe state, latched until the reset of every latched cause
  kInactive,  ///< the tool is raised or switched off by tool/enable; the axis holds
};
[[nodiscard]] std::string_view to_string(ControllerMode mode);

/// What the newest tracks say of the plants to protect.
enum class Protection : std::uint8_t { kComplete, kTooMany, kNotFinite };

struct SafetyEvent {
  enum class Kind : std::uint8_t { kLatched, kReset, kResetRefused };
  Kind kind = Kind::kLatched;
  SafetyCause cause = SafetyCause::kNone;
  Time time;
};
using SafetyEvents = BoundedVector<SafetyEvent, 2 * kSafetyCauses>;

/// The one owner of a tool's safety. It holds the deadlines, the latched causes and their resets,
/// and decides the mode; others obey. Every reaction is a row of safety_rules(). Called from one
/// thread; allocates nothing; times are of one clock.
class ToolSafety {
 public:
  /// The axis is to be measured within [lower_m, upper_m].
  ToolSafety(const ToolSafetyParameters& parameters, double lower_m, double upper_m);

  void heartbeat_came(Time now) { heartbeat_ = now; }
  void plan_came(Time now) { plan_ = now; }
  /// `newest_image`: the acquisition of the newest image in the tracks, so that tracks that are
  /// repeated grow old.
  void tracks_came(Time newest_image, Protection protection);
  /// Returns whether the odometry may be used: it is finite, and `arrival` differs from its stamp
  /// by odometry_delay_limit_s at most. A late message cannot be told from a clock that is off, and
  /// either puts the robot elsewhere. What is not used does not replace the last good stamp.
  [[nodiscard]] bool odometry_came(Time arrival, Time stamp, bool finite);
  void drive_read(const AxisReading& reading, Time now);
  /// The outcome of writing the valve's level. An opening that is not confirmed is a fault at once,
  /// a level that is to stay shut after valve_deadline_s.
  void valve_written(Time now, bool open, bool confirmed);
  void set_emergency_stop(bool pressed) { emergency_stop_ = pressed; }
  /// False: the tool is raised or switched off.
  void set_active(bool active) { active_ = active; }

  /// Latches what an earlier process left latched. Call before the first update.
  void restore(const CauseSet& latched, Time now);
  /// Asks for the reset of one cause, or of all with kNone. The reset of a cause that holds is
  /// refused. Causes of the drive are reset once the drive is back in service, which is
  /// tried only when nothing else is latched.
  void request_reset(SafetyCause cause);
  /// How far the drive is on its way back into service: `busy` while it is tried.
  void set_drive_recovery(bool busy) { drive_busy_ = busy; }

  /// Judges everything as of `now`. `axis_stopped`: the commanded motion has ended.
  void update(Time now, bool axis_stopped);

  /// What a waiting tool waits for: one input that is missing, stale or in fault; nothing when all
  /// is there.
  [[nodiscard]] std::optional<SafetyInput> missing(Time now) const;
  /// A cause that does not come from the drive demands by now that the valve is shut.
  [[nodiscard]] bool must_shut(Time now) const;

  [[nodiscard]] ControllerMode mode() const { return mode_; }
  /// The cause that was latched first of those that are latched; kNone: none is.
  [[nodiscard]] SafetyCause first_cause() const { return first_cause_; }
  [[nodiscard]] Time cause_time() const { return cause_time_; }
  [[nodiscard]] const CauseSet& latched() const { return latched_; }
  /// The strictest reaction of the latched causes. @pre mode() is kSafe.
  [[nodiscard]] StopCategory stop() const;
  /// Whether the drive is to be in service: false while a latched cause removes its power.
  [[nodiscard]] bool drive_wanted() const;
  /// Since the last call, oldest first.
  [[nodiscard]] SafetyEvents take_events();

 private:
  [[nodiscard]] bool judged(const SafetyRule& rule) const;
  [[nodiscard]] bool older_than(const std::optional<Time>& stamp, Time now, double seconds) const;
  [[nodiscard]] bool holds(SafetyCause cause, Time now) const;
  [[nodiscard]] bool drive_fault_holds() const;
  [[nodiscard]] bool position_limit_holds() const;
  [[nodiscard]] bool following_error_holds(Time now) const;
  [[nodiscard]] bool valve_fault_holds(Time now) const;
  void note_loop(Time now);
  void answer_resets(Time now);
  void answer_drive_resets(Time now);
  void latch_what_holds(Time now);
  void latch(SafetyCause cause, Time now);
  void unlatch(SafetyCause cause, Time now);
  void refuse(SafetyCause cause, Time now);
  void choose_mode(Time now);

  ToolSafetyParameters parameters_;
  double lower_m_;
  double upper_m_;

  std::optional<Time> heartbeat_;
  std::optional<Time> plan_;
  std::optional<Time> tracks_;
  Protection protection_ = Protection::kComplete;
  std::optional<Time> odometry_;
  bool odometry_finite_ = true;
  std::optional<AxisReading> reading_;
  std::optional<Time> following_error_since_;
  bool valve_confirmed_shut_ = false;
  bool opening_failed_ = false;
  std::optional<Time> valve_unconfirmed_since_;
  bool emergency_stop_ = false;
  bool active_ = true;
  std::optional<Time> last_update_;
  bool loop_stalled_ = false;

  ControllerMode mode_ = ControllerMode::kWaiting;
  CauseSet latched_;
  CauseSet reset_requests_;
  bool drive_in_service_ = false;  ///< it was, and was not taken out
  bool drive_recovering_ = false;
  bool drive_busy_ = false;
  SafetyCause first_cause_ = SafetyCause::kNone;
  Time cause_time_;
  SafetyEvents events_;
};

}  // namespace furrow::actuation
