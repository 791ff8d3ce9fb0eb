#include "furrow_core/text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace furrow {
namespace {

TEST(Fixed, RoundsToTheDecimalsAskedFor) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");  // to even: 1.25 is exact in binary
  EXPECT_EQ(fixed(1234.5678, 3), "1234.568");
  EXPECT_EQ(fixed(7.0, 0), "7");
}

TEST(Fixed, HasNoNegativeZero) {
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(-0.01, 2), "-0.01");
}

TEST(Fixed, ShowsADashForAValueThatIsNotFinite) {
  EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 2), "-");
  EXPECT_EQ(fixed(-std::numeric_limits<double>::infinity(), 2), "-");
}

TEST(Fixed, TakesTheLargestNumbers) {
  EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 0).size(), 309U);
}

TEST(TextTable, AlignsTheFirstColumnLeftAndTheOthersRight) {
  EXPECT_EQ(text_table({{"name", "n"}, {"a", "100"}, {"short"}}),
            "name     n\n"
            "a      100\n"
            "short\n");
}

TEST(Text, TrimmedHasNoBlanksAtEitherEnd) {
  EXPECT_EQ(trimmed(" \ta b\t "), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed("\r\na ", "\r\n"), "a ");
}

TEST(Text, ATypoIsAnsweredByTheNearestName) {
  const std::vector<std::string> names = {"planner", "tracker"};
  EXPECT_EQ(did_you_mean("plnner", names), "; did you mean 'planner'?");
  EXPECT_EQ(did_you_mean("camera_simulator", names), "");
  EXPECT_EQ(did_you_mean("planner", {}), "");
}

}  // namespace
}  // namespace furrow
