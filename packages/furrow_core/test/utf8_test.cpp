#include "furrow_core/utf8.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Utf8, AcceptsCharactersOfEachLength) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(
      is_utf8("R\xC3\xBC"
              "be \xE2\x82\xAC \xF0\x9F\x8C\xB1"));
  EXPECT_TRUE(is_utf8("\xF4\x8F\xBF\xBF"));  // U+10FFFF
}

TEST(Utf8, NamesTheFirstByteThatIsNot) {
  EXPECT_EQ(first_invalid_utf8("R\xFC"
                               "be"),
            1u);                                          // Latin-1
  EXPECT_EQ(first_invalid_utf8("ab\xE2\x82"), 2u);        // ends within a character
  EXPECT_EQ(first_invalid_utf8("\xC0\xAF"), 0u);          // overlong
  EXPECT_EQ(first_invalid_utf8("\xE0\x80\xAF"), 0u);      // overlong
  EXPECT_EQ(first_invalid_utf8("\xED\xA0\x80"), 0u);      // surrogate
  EXPECT_EQ(first_invalid_utf8("\xF4\x90\x80\x80"), 0u);  // above U+10FFFF
  EXPECT_EQ(first_invalid_utf8("a\x80"), 1u);             // continuation on its own
}

TEST(Utf8, ReplacesBytesThatAreNot) {
  EXPECT_EQ(with_valid_utf8("R\xFC"
                            "be"),
            "R\xEF\xBF\xBD"
            "be");
  EXPECT_EQ(with_valid_utf8("\xFF\xFF"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(with_valid_utf8("beet"), "beet");
}

}  // namespace
}  // namespace furrow
