#pragma once

#include <algorithm>
#include <chrono>

namespace furrow::actuation {

/// How long one call of a device may block, however many exchanges it takes.
class CallBudget {
 public:
  explicit CallBudget(double seconds)
      : end_(std::chrono::steady_clock::now() +
             std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                 std::chrono::duration<double>(seconds))) {}

  /// At least 0.
  [[nodiscard]] double left_s() const {
    const std::chrono::duration<double> left = end_ - std::chrono::steady_clock::now();
    return std::max(0.0, left.count());
  }

 private:
  std::chrono::steady_clock::time_point end_;
};

}  // namespace furrow::actuation
