#pragma once

#include <optional>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"

namespace furrow::tracking {

/// How far a fused pose moves beyond what the robot drives, as when a GNSS position corrects the
/// drift of the wheels. What was placed in F by earlier poses has not moved against the robot: a
/// tool on the robot finds it where `pending()` brings it.
class PoseCorrection {
 public:
  /// Longer gaps between poses count as driven, whatever the pose says.
  explicit PoseCorrection(Duration longest_gap = Duration::seconds(0.5))
      : longest_gap_(longest_gap) {}

  /// The next pose, and the robot's speed ahead and yaw rate there, by which it is expected from
  /// the last one (the mean of both, along an arc). kInvalidArgument: not finite; kStale: not
  /// newer.
  Status add(Time stamp, const geometry::Pose2& X_FB, double speed_mps, double yaw_rate_radps);

  /// All corrections since clear(), as a motion of points in F; identity where there are none.
  [[nodiscard]] const geometry::Pose2& pending() const { return correction_; }
  void clear() { correction_ = {}; }

 private:
  struct Entry {
    Time stamp;
    geometry::Pose2 X_FB;
    double speed_mps = 0.0;
    double yaw_rate_radps = 0.0;
  };
  Duration longest_gap_;
  std::optional<Entry> newest_;
  geometry::Pose2 correction_;
};

}  // namespace furrow::tracking
