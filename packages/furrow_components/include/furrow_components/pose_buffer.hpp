#pragma once

#include <deque>

#include "furrow_components/conversions.hpp"
#include "furrow_core/result.hpp"

namespace furrow::components {

/// The poses of the base over the last seconds, for look-up by the stamp of an image. Bounded.
class PoseBuffer {
 public:
  explicit PoseBuffer(Duration memory) : memory_(memory) {}

  /// kStale: the stamp is not newer than the newest one, or ahead of it by more than the memory. So
  /// a single wrong stamp does not block the correct ones after it. After kAgreeing stamps ahead in
  /// a row, each newer than the one before, time has jumped: the last of them is added.
  /// kInvalidArgument: not finite.
  Status add(const BaseOdometry& odometry);
  /// Interpolated between two neighbours. Up to `ahead` beyond the newest pose, extrapolated by its
  /// twist. kUnavailable: empty. kStale: before the oldest or too far ahead.
  [[nodiscard]] Result<BaseOdometry> at(Time stamp, Duration ahead = Duration()) const;
  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] const BaseOdometry& newest() const { return poses_.back(); }

  static constexpr int kAgreeing = 3;

 private:
  [[nodiscard]] bool is_astray(Time stamp);

  Duration memory_;
  Time astray_;           ///< newest stamp that was too far ahead
  int astray_count_ = 0;  ///< stamps too far ahead in a row
  std::deque<BaseOdometry> poses_;
};

}  // namespace furrow::components
