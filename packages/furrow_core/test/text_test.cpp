#include "furrow_core/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace furrow {
namespace {

TEST(Fixed, HasTheGivenNumberOfDecimals) {
  EXPECT_EQ(fixed(1.5, 3), "1.500");
  EXPECT_EQ(fixed(-2.0, 0), "-2");
  EXPECT_EQ(fixed(123456.789, 1), "123456.8");
}

TEST(Fixed, ZeroHasNoSign) {
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(-0.0, 0), "0");
}

TEST(Fixed, IsADashWhereTheNumberIsNotFinite) {
  EXPECT_EQ(fixed(std::nan(""), 2), "-");
  EXPECT_EQ(fixed(-std::numeric_limits<double>::infinity(), 2), "-");
}

TEST(Fixed, TakesTheLargestNumbers) {
  EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 0).size(), 309u);
}

}  // namespace
}  // namespace furrow
