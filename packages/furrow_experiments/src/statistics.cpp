#include "furrow_experiments/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace furrow::experiments {
namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
}

MeanAndSpread mean_and_sd(std::span<const double> values) {
  if (values.empty()) return {kNan, kNan};
  const auto count = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values) mean += value / count;
  if (values.size() < 2) return {mean, kNan};
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (count - 1.0))};
}

double student_t_975(std::size_t degrees) {
  constexpr std::array<double, 2> kFew = {12.706204736174698, 4.302652729749464};
  if (degrees <= kFew.size()) return kFew[degrees - 1];
  constexpr double kZ = 1.959963984540054;
  const double z3 = kZ * kZ * kZ;
  const double z5 = z3 * kZ * kZ;
  const double z7 = z5 * kZ * kZ;
  const double z9 = z7 * kZ * kZ;
  const auto n = static_cast<double>(degrees);
  return kZ + (z3 + kZ) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * kZ) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * kZ) / (384.0 * n * n * n) +
         (79.0 * z9 + 776.0 * z7 + 1482.0 * z5 - 1920.0 * z3 - 945.0 * kZ) /
             (92160.0 * n * n * n * n);
}

double ci95_half_width(std::span<const double> values) {
  if (values.size() < 2) return kNan;
  return student_t_975(values.size() - 1) * mean_and_sd(values).sd /
         std::sqrt(static_cast<double>(values.size()));
}

}  // namespace furrow::experiments
