#pragma once

#include <optional>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"

namespace furrow::tracking {

/// Motion of a fused pose beyond the robot's own motion, as when a GNSS position corrects the drift
/// of the wheels. Points placed in F by earlier poses have not moved relative to the robot:
/// `pending()` moves them to where a tool on the robot finds them.
class PoseCorrection {
 public:
  /// Longer gaps between poses count as driven, whatever the pose says.
  explicit PoseCorrection(Duration longest_gap = Duration::seconds(0.5))
      : longest_gap_(longest_gap) {}

  /// The next pose with the robot's forward speed and yaw rate. The expected pose follows from the
  /// last one along an arc, at the mean of both speeds. kInvalidArgument: not finite; kStale: not
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
