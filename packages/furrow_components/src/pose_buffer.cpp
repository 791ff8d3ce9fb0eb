#include "furrow_components/pose_buffer.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::components {

Status PoseBuffer::add(const BaseOdometry& odometry) {
  const bool finite = std::isfinite(odometry.X_FB.x_m) && std::isfinite(odometry.X_FB.y_m) &&
                      std::isfinite(odometry.X_FB.heading_rad) &&
                      std::isfinite(odometry.speed_mps) && std::isfinite(odometry.yaw_rate_radps);
  if (!finite) return Error{ErrorCode::kInvalidArgument, "odometry is not finite"};
  if (!poses_.empty() && odometry.stamp <= poses_.back().stamp) {
    return Error{ErrorCode::kStale, "odometry goes back in time"};
  }
  if (is_astray(odometry.stamp)) return Error{ErrorCode::kStale, "odometry jumps ahead in time"};
  poses_.push_back(odometry);
  while (poses_.front().stamp + memory_ < odometry.stamp) poses_.pop_front();
  return {};
}

bool PoseBuffer::is_astray(Time stamp) {
  if (poses_.empty() || stamp <= poses_.back().stamp + memory_) {
    astray_count_ = 0;
    return false;
  }
  const bool goes_on = astray_count_ > 0 && stamp > astray_ && stamp <= astray_ + memory_;
  astray_count_ = goes_on ? astray_count_ + 1 : 1;
  astray_ = stamp;
  if (astray_count_ < kAgreeing) return true;
  astray_count_ = 0;
  return false;
}

Result<BaseOdometry> PoseBuffer::at(Time stamp, Duration ahead) const {
  if (poses_.empty()) return Error{ErrorCode::kUnavailable, "no odometry was received"};
  const BaseOdometry& newest = poses_.back();
  if (stamp > newest.stamp) {
    if (stamp > newest.stamp + ahead) return Error{ErrorCode::kStale, "odometry is too old"};
    BaseOdometry moved = newest;
    moved.stamp = stamp;
    moved.X_FB = geometry::extrapolate(newest.X_FB, {newest.speed_mps, 0.0, newest.yaw_rate_radps},
                                       (stamp - newest.stamp).to_seconds());
    return moved;
  }
  const auto after = std::ranges::lower_bound(poses_, stamp, {}, &BaseOdometry::stamp);
  if (after->stamp == stamp) return *after;
  if (after == poses_.begin())
    return Error{ErrorCode::kStale, "the stamp is older than the stored odometry"};
  const BaseOdometry& b = *after;
  const BaseOdometry& a = *std::prev(after);
  const double fraction = (stamp - a.stamp).to_seconds() / (b.stamp - a.stamp).to_seconds();
  return BaseOdometry{stamp, geometry::interpolate(a.X_FB, b.X_FB, fraction),
                      a.speed_mps + fraction * (b.speed_mps - a.speed_mps),
                      a.yaw_rate_radps + fraction * (b.yaw_rate_radps - a.yaw_rate_radps)};
}

}  // namespace furrow::components
