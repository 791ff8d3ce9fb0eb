#include "file_names.hpp"

#include <gtest/gtest.h>

#include "furrow_core/random.hpp"

namespace furrow::annotation {
namespace {

TEST(FileNames, AreRelativeUnderTheFolderOnly) {
  EXPECT_EQ(relative_to("/a/b/c.png", "/a"), "b/c.png");
  EXPECT_EQ(relative_to("/a/./b/../c.png", "/a"), "c.png");
  EXPECT_EQ(relative_to("/x/c.png", "/a"), "/x/c.png");
}

TEST(FileNames, AnyBytesComeBackFromPercentCoding) {
  EXPECT_EQ(percent_encoded("r\xFC"
                            "be 1%.png"),
            "r%FCbe%201%25.png");
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    std::string bytes;
    for (int i = 0; i < 20; ++i) bytes += static_cast<char>(random.integer(0, 255));
    EXPECT_EQ(percent_decoded(percent_encoded(bytes)), bytes);
  }
  for (const char* bad : {"%", "a%2", "%x0", "% 1"}) EXPECT_FALSE(percent_decoded(bad)) << bad;
}

}  // namespace
}  // namespace furrow::annotation
