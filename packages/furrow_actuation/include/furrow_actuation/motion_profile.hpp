#pragma once

#include "furrow_actuation/bounded_vector.hpp"
#include "furrow_core/result.hpp"
#include "furrow_geometry/tool_model.hpp"

namespace furrow::actuation {

/// What one axis may do. Each bound holds in both directions; lower_m < upper_m.
struct MotionLimits {
  double lower_m = 0.0;
  double upper_m = 0.0;
  double max_velocity_mps = 0.0;
  double max_acceleration_mps2 = 0.0;
  double max_jerk_mps3 = 0.0;

  [[nodiscard]] static MotionLimits of(const geometry::AxisModel& axis);
};

struct MotionState {
  double position_m = 0.0;
  double velocity_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

/// A movement as pieces of constant jerk; a value of fixed size.
class MotionProfile {
 public:
  /// Standing at a position: duration 0.
  [[nodiscard]] static MotionProfile standing(double position_m);

  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// The state `t_s` after the start. Before the start the first state, after the end the last one.
  [[nodiscard]] MotionState at(double t_s) const;
  [[nodiscard]] const MotionState& final_state() const { return final_; }

  struct Range {
    double min_m = 0.0;
    double max_m = 0.0;
  };
  /// The least and the greatest position along the whole movement.
  [[nodiscard]] Range position_range() const;
  [[nodiscard]] double peak_speed_mps() const;

  static constexpr std::size_t kMaxSegments = 16;
  struct Segment {
    double start_s = 0.0;
    MotionState start;
    double jerk_mps3 = 0.0;
  };
  [[nodiscard]] const BoundedVector<Segment, kMaxSegments>& segments() const { return segments_; }

  /// Starts a movement that is then built by append(). The last state is `start` until then.
  explicit MotionProfile(const MotionState& start = {}) : first_(start), final_(start) {}
  /// Continues for `duration_s` >= 0 with constant jerk; nothing at 0.
  /// @pre fewer than kMaxSegments segments so far.
  void append(double duration_s, double jerk_mps3);
  /// The same after setting the acceleration, for profiles without a jerk limit.
  void append_acceleration(double duration_s, double acceleration_mps2);
  /// Replaces the last state, to take out rounding.
  void set_final(const MotionState& state) { final_ = state; }

 private:
  BoundedVector<Segment, kMaxSegments> segments_;
  MotionState first_;
  MotionState final_;
  double duration_s_ = 0.0;
};

/// The quickest movement from `start` to rest at `target_m` under velocity and acceleration limits:
/// a trapezoid or triangle of velocity. Acceleration jumps, and start.acceleration_mps2 is ignored.
/// A start that moves away or too fast first brakes and comes back.
///
/// - kInvalidArgument: a number that is not finite, limits that are not positive.
/// - kOutOfRange: target outside the position limits, start beyond the velocity limit.
/// - kNoSolution: braking from `start` passes a position limit.
[[nodiscard]] Result<MotionProfile> plan_trapezoid(const MotionLimits& limits,
                                                   const MotionState& start, double target_m);

/// The quickest movement from `start`, which may move and accelerate, to rest at `target_m`, also
/// under the jerk limit. It follows the fastest way to the velocity limit and leaves it at the
/// instant from which the fastest stop ends at the target (the switching surface of the triple
/// integrator; compare Haschke, Weitnauer and Ritter 2008). Where the quickest movement would pass
/// a position limit, a slower one that does not is taken. Fails as plan_trapezoid does; kOutOfRange
/// also for a start beyond the acceleration limit or bound to exceed the velocity limit.
[[nodiscard]] Result<MotionProfile> plan_s_curve(const MotionLimits& limits,
                                                 const MotionState& start, double target_m);

/// The quickest movement from `start` to rest anywhere, under acceleration and jerk limits. It
/// always stops, also from states outside the limits (it is the emergency's movement): it stays
/// inside the position limits whenever `start` comes from a movement planned here.
[[nodiscard]] MotionProfile plan_stop(const MotionLimits& limits, const MotionState& start);

}  // namespace furrow::actuation
