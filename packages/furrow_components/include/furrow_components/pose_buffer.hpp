#pragma once

#include <deque>

#include "furrow_components/conversions.hpp"
#include "furrow_core/result.hpp"

namespace furrow::components {

/// The base's poses over the last seconds, to look up the one at an image's stamp. Bounded.
class PoseBuffer {
 public:
  explicit PoseBuffer(Duration memory) : memory_(memory) {}

  /// kStale when the stamp is not newer than the newest one; kInvalidArgument when it is not
  /// finite.
  Status add(const BaseOdometry& odometry);
  /// Interpolated between two neighbours; extrapolated by its twist up to `ahead` beyond the
  /// newest. kUnavailable: empty. kStale: before the oldest or too far ahead.
  [[nodiscard]] Result<BaseOdometry> at(Time stamp, Duration ahead = Duration()) const;
  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] const BaseOdometry& newest() const { return poses_.back(); }

 private:
  Duration memory_;
  std::deque<BaseOdometry> poses_;
};

}  // namespace furrow::components
