#pragma once

#include <deque>

#include "furrow_components/conversions.hpp"
#include "furrow_core/result.hpp"

namespace furrow::components {

/// The base's poses over the last seconds, to look up the one at an image's stamp. Bounded.
class PoseBuffer {
 public:
  explicit PoseBuffer(Duration memory) : memory_(memory) {}

  /// kStale: the stamp is not newer than the newest one, or ahead of it by more than the memory. A
  /// single stamp that is wrong does not shut out those that follow; when kAgreeing in a row go on
  /// from each other there, time has moved, and the last of them is taken. kInvalidArgument: not
  /// finite.
  Status add(const BaseOdometry& odometry);
  /// Interpolated between two neighbours; extrapolated by its twist up to `ahead` beyond the
  /// newest. kUnavailable: empty. kStale: before the oldest or too far ahead.
  [[nodiscard]] Result<BaseOdometry> at(Time stamp, Duration ahead = Duration()) const;
  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] const BaseOdometry& newest() const { return poses_.back(); }

  static constexpr int kAgreeing = 3;

 private:
  [[nodiscard]] bool is_astray(Time stamp);

  Duration memory_;
  Time astray_;           ///< newest stamp too far ahead
  int astray_count_ = 0;  ///< of these, in a row
  std::deque<BaseOdometry> poses_;
};

}  // namespace furrow::components
