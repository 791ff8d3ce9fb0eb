#pragma once

#include <ranges>

namespace furrow {

/// Whether these are probabilities of things that exclude one another: each in [0, 1], and 1 in sum
/// at most. The tolerance of the sum, 1e-3, is for single precision and rounded numbers. False for
/// NaN.
template <std::ranges::input_range Probabilities>
[[nodiscard]] bool is_distribution(Probabilities&& probabilities) {
  constexpr double kSumTolerance = 1e-3;
  double sum = 0.0;
  for (const double p : probabilities) {
    if (!(p >= 0.0 && p <= 1.0)) return false;
    sum += p;
  }
  return sum <= 1.0 + kSumTolerance;
}

}  // namespace furrow
