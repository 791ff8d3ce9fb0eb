#pragma once

#include <array>
#include <cstdint>

#include "furrow_core/time.hpp"

namespace furrow::graph {

/// Histogram of the delay of calls, in bins of 10 us up to 20 ms. add() allocates nothing.
class LatenessHistogram {
 public:
  void add(Duration late);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// The p-quantile, rounded up to its bin; the maximum if it lies beyond the bins.
  [[nodiscard]] Duration quantile(double p) const;
  [[nodiscard]] Duration max() const { return max_; }

 private:
  static constexpr std::int64_t kBin_ns = 10'000;
  std::array<std::uint32_t, 2000> bins_{};
  std::uint64_t count_ = 0;
  Duration max_;
};

}  // namespace furrow::graph
