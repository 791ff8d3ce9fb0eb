#include "furrow_log/level.hpp"

#include <gtest/gtest.h>

#include "furrow_core/error.hpp"

namespace furrow::log {
namespace {

TEST(Levels, NamesGoBothWays) {
  for (const Level level :
       {Level::kDebug, Level::kInfo, Level::kWarn, Level::kError, Level::kFatal}) {
    EXPECT_EQ(level_from_string(to_string(level)), level);
  }
  EXPECT_FALSE(level_from_string("loud").has_value());
}

TEST(Levels, ComponentOverridesTheCommonLevel) {
  Levels levels;
  EXPECT_EQ(levels.of("planner"), Level::kInfo);
  levels.set("warn");
  levels.set("planner=debug");
  EXPECT_EQ(levels.of("planner"), Level::kDebug);
  EXPECT_EQ(levels.of("tracker"), Level::kWarn);
}

TEST(Levels, ComponentsAreThoseWithALevelOfTheirOwn) {
  Levels levels;
  levels.set("warn");
  EXPECT_TRUE(levels.components().empty());
  levels.set("tracker=debug");
  levels.set("planner=info");
  EXPECT_EQ(levels.components(), (std::vector<std::string>{"planner", "tracker"}));
}

TEST(Levels, MalformedSettingNamesTheForms) {
  Levels levels;
  for (const char* setting : {"loud", "", "planner=", "=warn", "planner=WARN"}) {
    try {
      levels.set(setting);
      ADD_FAILURE() << setting;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("COMPONENT=LEVEL"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace furrow::log
