#include "furrow_tracking/pose_correction.hpp"

#include <cmath>

namespace furrow::tracking {

Status PoseCorrection::add(Time stamp, const geometry::Pose2& X_FB, double speed_mps,
                           double yaw_rate_radps) {
  for (const double value : {X_FB.x_m, X_FB.y_m, X_FB.heading_rad, speed_mps, yaw_rate_radps}) {
    if (!std::isfinite(value)) {
      return Error{ErrorCode::kInvalidArgument, "the pose or its speed is not finite"};
    }
  }
  if (newest_ && stamp <= newest_->stamp) {
    return Error{ErrorCode::kStale, "the pose is not newer than the last one"};
  }
  if (newest_ && stamp - newest_->stamp <= longest_gap_) {
    const double dt_s = (stamp - newest_->stamp).to_seconds();
    const double way_m = 0.5 * (newest_->speed_mps + speed_mps) * dt_s;
    const double turn_rad = 0.5 * (newest_->yaw_rate_radps + yaw_rate_radps) * dt_s;
    const geometry::Pose2 expected = geometry::compose(
        newest_->X_FB,
        {way_m * std::cos(0.5 * turn_rad), way_m * std::sin(0.5 * turn_rad), turn_rad});
    correction_ =
        geometry::compose(geometry::compose(X_FB, geometry::inverse(expected)), correction_);
  }
  newest_ = Entry{stamp, X_FB, speed_mps, yaw_rate_radps};
  return {};
}

}  // namespace furrow::tracking
