#include "furrow_msgs/topics.hpp"

#include <gtest/gtest.h>

#include <set>

namespace furrow::msgs {
namespace {

TEST(Topics, NamesAreUniqueAndPlain) {
  std::set<std::string_view> names;
  for (const Topic& topic : all_topics()) {
    EXPECT_TRUE(names.insert(topic.name).second) << topic.name;
    EXPECT_EQ(topic.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_/"), std::string_view::npos);
    EXPECT_NE(topic.type, nullptr);
    EXPECT_GE(topic.qos.depth, 1);
    EXPECT_FALSE(topic.description.empty());
    EXPECT_EQ(find_topic(topic.name), &topic);
  }
  EXPECT_EQ(find_topic("nothing"), nullptr);
}

TEST(Topics, StructsFindTheirRow) {
  EXPECT_EQ(topics::Plan::topic().name, "planner/plan");
  EXPECT_EQ(topics::Plan::topic().type, &message_type<topics::Plan::Message>());
  EXPECT_EQ(topics::RobotDescription::topic().name, "robot_description");
  EXPECT_EQ(topics::Instances::topic().name, "perception/instances");
  EXPECT_EQ(topics::Markers::topic().name, "markers");
  EXPECT_EQ(topics::TrueOdometry::topic().name, "truth/odometry");
  EXPECT_EQ(topics::Rosout::topic().name, "rosout");
  EXPECT_EQ(all_topics().back().name, "rosout");
}

TEST(Topics, MarkdownListsEach) {
  const std::string text = topics_markdown();
  for (const Topic& topic : all_topics()) {
    EXPECT_NE(text.find("`" + std::string(topic.name) + "`"), std::string::npos);
  }
}

}  // namespace
}  // namespace furrow::msgs
