#pragma once

#include <optional>

#include "furrow_actuation/bounded_vector.hpp"
#include "furrow_actuation/crossing.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation {

/// How the robot makes its way over ground: when it stood, and how far it is behind the furthest
/// point that it reached. From the twist alone, so that corrections of the pose do not count as
/// motion. Allocates nothing.
class GroundProgress {
 public:
  /// Slower than this in both directions, the robot stands.
  static constexpr double kStandingSpeed_mps = 0.005;

  /// The next odometry; one that is not newer than the last is left out.
  void add(const BaseState& base);

  [[nodiscard]] bool standing() const { return stood_since_.has_value(); }
  /// 0 on new ground; else the way that the robot has to drive until it is there again.
  [[nodiscard]] double behind_m() const { return behind_m_; }
  /// The seconds in motion between `since` and `now`. Of long ago only the last kMaxPauses pauses
  /// are known; what is not known counts as motion.
  [[nodiscard]] double motion_s(Time since, Time now) const;
  /// Begins anew, as after a turn with the tool raised.
  void begin_new_ground() { behind_m_ = 0.0; }

  static constexpr std::size_t kMaxPauses = 32;

 private:
  struct Pause {
    Time from;
    Time to;
  };
  std::optional<BaseState> last_;
  std::optional<Time> stood_since_;
  BoundedVector<Pause, kMaxPauses> pauses_;
  double behind_m_ = 0.0;
};

}  // namespace furrow::actuation
