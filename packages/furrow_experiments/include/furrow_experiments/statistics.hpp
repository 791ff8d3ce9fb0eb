#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace furrow::experiments {

struct MeanAndSpread {
  double mean = 0.0;  ///< NaN of nothing
  double sd = 0.0;    ///< of the sample (n - 1); NaN of fewer than two values
};
[[nodiscard]] MeanAndSpread mean_and_sd(std::span<const double> values);

/// Half the width of the 95 % confidence interval of the mean of independent values, by Student's
/// t. NaN of fewer than two values.
[[nodiscard]] double ci95_half_width(std::span<const double> values);

/// The 97.5 % quantile of Student's t: the exact formulas for one and two degrees of freedom, else
/// the expansion of Abramowitz and Stegun (1964), 26.7.5, to within 0.01. @pre degrees >= 1.
[[nodiscard]] double student_t_975(std::size_t degrees);

}  // namespace furrow::experiments
