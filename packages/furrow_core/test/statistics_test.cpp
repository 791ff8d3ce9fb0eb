#include "furrow_core/statistics.hpp"

#include <gtest/gtest.h>

#include "furrow_core/random.hpp"

namespace furrow {
namespace {

TEST(Quantile, IsLinearBetweenRanks) {
  const std::vector<double> values = {40.0, 10.0, 30.0, 20.0};  // ranks 0 to 3
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 25.0);  // rank 1.5
  EXPECT_DOUBLE_EQ(quantile(values, 0.9), 37.0);  // rank 2.7
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 40.0);
}

TEST(Quantile, BringsTheFractionIntoItsRange) {
  EXPECT_DOUBLE_EQ(quantile({1.0, 2.0}, -1.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile({1.0, 2.0}, 7.0), 2.0);
}

TEST(Quantile, OfNothingIsNan) {
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_TRUE(std::isnan(quantile_of_sorted({}, 0.5)));
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Quantile, IsTheSameOfSortedAndOfUnsortedValues) {
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    std::vector<double> values;
    for (auto n = random.integer(1, 30); n > 0; --n) values.push_back(random.normal(0.0, 5.0));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const double fraction = random.uniform();
    EXPECT_EQ(quantile(values, fraction), quantile_of_sorted(sorted, fraction));
  }
}

TEST(Median, OfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
  EXPECT_DOUBLE_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_DOUBLE_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
}

TEST(MedianElement, OfAnEvenNumberIsTheUpperOne) {
  std::vector<float> values = {4.0f, 1.0f, 3.0f, 2.0f};
  EXPECT_EQ(median_element(std::span(values)), 3.0f);
  std::vector<int> descending = {5, 1, 4, 2, 3};
  EXPECT_EQ(median_element(std::span(descending), std::greater<>()), 3);
}

}  // namespace
}  // namespace furrow
