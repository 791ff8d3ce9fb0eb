#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace furrow {

/// The quantile at `fraction` of values that are sorted in ascending order: linear between the two
/// nearest ranks (definition 7 of Hyndman and Fan 1996). `fraction` is brought into [0, 1]. NaN of
/// no values. @pre no value is NaN.
[[nodiscard]] inline double quantile_of_sorted(std::span<const double> sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

/// As quantile_of_sorted, of values in any order. Linear time. For several quantiles of the same
/// values, sort once.
[[nodiscard]] inline double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), nth, values.end());
  if (below + 1 == values.size()) return *nth;
  return std::lerp(*nth, *std::min_element(nth + 1, values.end()),
                   rank - static_cast<double>(below));
}

/// The mean of the two middle values where their number is even. NaN of no values.
[[nodiscard]] inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

/// The middle element in the order of `less`; for an even number of elements the upper of the two.
/// Reorders `values`. Linear time. @pre not empty.
template <class T, class Less = std::less<>>
[[nodiscard]] T& median_element(std::span<T> values, Less less = {}) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end(), less);
  return *middle;
}

}  // namespace furrow
