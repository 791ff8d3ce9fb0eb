#include "lateness.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::graph {

void LatenessHistogram::add(Duration late) {
  const std::int64_t late_ns = std::max<std::int64_t>(0, late.count_ns());
  const auto bin = static_cast<std::size_t>(late_ns / kBin_ns);
  if (bin < bins_.size()) ++bins_[bin];
  ++count_;
  max_ = std::max(max_, Duration::nanoseconds(late_ns));
}

Duration LatenessHistogram::quantile(double p) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(p * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    seen += bins_[i];
    if (seen >= wanted && seen > 0) {
      return std::min(max_, Duration::nanoseconds(kBin_ns * static_cast<std::int64_t>(i + 1)));
    }
  }
  return max_;
}

}  // namespace furrow::graph
