#include "furrow_recording/topic_filter.hpp"

#include <gtest/gtest.h>

#include "furrow_core/random.hpp"

namespace furrow::recording {
namespace {

// The definition, by recursion.
bool by_definition(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) {
    return text.empty();
  }
  if (pattern.front() == '*') {
    return by_definition(pattern.substr(1), text) ||
           (!text.empty() && by_definition(pattern, text.substr(1)));
  }
  return !text.empty() && (pattern.front() == '?' || pattern.front() == text.front()) &&
         by_definition(pattern.substr(1), text.substr(1));
}

TEST(Glob, EqualsItsDefinition) {
  Random random(1, "glob");
  int matched = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string pattern;
    std::string text;
    for (auto n = random.integer(0, 6); n > 0; --n) {
      pattern += "ab*?"[random.integer(0, 3)];
    }
    for (auto n = random.integer(0, 7); n > 0; --n) {
      text += "ab"[random.integer(0, 1)];
    }
    const bool expected = by_definition(pattern, text);
    matched += expected ? 1 : 0;
    ASSERT_EQ(matches_glob(pattern, text), expected) << pattern << " " << text;
  }
  EXPECT_GT(matched, 1000);
}

TEST(Glob, ManyStarsTakeNoTime) {
  std::string pattern;
  for (int i = 0; i < 1000; ++i) {
    pattern += "*a";
  }
  EXPECT_FALSE(matches_glob(pattern + "b", std::string(2000, 'a')));
}

TEST(TopicFilter, IncludesThenExcludesWithOrWithoutSlash) {
  const TopicFilter filter{{"camera/*", "/tf*"}, {"*depth"}};
  EXPECT_TRUE(filter.accepts("camera/image"));
  EXPECT_TRUE(filter.accepts("/camera/image"));
  EXPECT_TRUE(filter.accepts("tf_static"));
  EXPECT_FALSE(filter.accepts("camera/depth"));
  EXPECT_FALSE(filter.accepts("imu/data"));
  EXPECT_TRUE(TopicFilter{}.accepts("anything"));
  EXPECT_TRUE(TopicFilter{}.accepts("//foreign"));
  EXPECT_FALSE((TopicFilter{{}, {}}.accepts("a")));
}

}  // namespace
}  // namespace furrow::recording
