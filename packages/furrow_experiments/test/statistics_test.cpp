#include "furrow_experiments/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow::experiments {
namespace {

TEST(Statistics, MeanAndSpreadOfTheSample) {
  const std::vector<double> values = {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
  const MeanAndSpread result = mean_and_sd(values);
  EXPECT_DOUBLE_EQ(result.mean, 5.0);
  EXPECT_NEAR(result.sd, std::sqrt(32.0 / 7.0), 1e-12);
}

TEST(Statistics, TooFewValuesHaveNoSpread) {
  EXPECT_TRUE(std::isnan(mean_and_sd({}).mean));
  const std::vector<double> one = {3.0};
  EXPECT_DOUBLE_EQ(mean_and_sd(one).mean, 3.0);
  EXPECT_TRUE(std::isnan(mean_and_sd(one).sd));
  EXPECT_TRUE(std::isnan(ci95_half_width(one)));
}

TEST(Statistics, StudentTAgreesWithTables) {
  // Quantiles as any table of the distribution has them.
  EXPECT_NEAR(student_t_975(1), 12.7062, 1e-3);
  EXPECT_NEAR(student_t_975(2), 4.3027, 1e-3);
  EXPECT_NEAR(student_t_975(3), 3.1824, 1e-2);
  EXPECT_NEAR(student_t_975(5), 2.5706, 1e-3);
  EXPECT_NEAR(student_t_975(19), 2.0930, 1e-4);
  EXPECT_NEAR(student_t_975(1000), 1.9623, 1e-4);
}

TEST(Statistics, ConfidenceIntervalOfTwoValues) {
  const std::vector<double> values = {1.0, 3.0};
  EXPECT_NEAR(ci95_half_width(values), 12.7062 * std::sqrt(2.0) / std::sqrt(2.0), 1e-3);
}

}  // namespace
}  // namespace furrow::experiments
