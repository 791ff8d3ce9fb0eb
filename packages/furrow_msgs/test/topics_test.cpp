#include "furrow_msgs/topics.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

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

template <class... Structs>
void expect_rows_in_order() {
  const std::vector<const Topic*> rows = {&Structs::topic()...};
  const std::vector<const MessageType*> types = {&message_type<typename Structs::Message>()...};
  ASSERT_EQ(rows.size(), all_topics().size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i], &all_topics()[i]) << all_topics()[i].name;
    EXPECT_EQ(rows[i]->type, types[i]) << rows[i]->name;
  }
}

TEST(Topics, StructsFindTheirRow) {
  namespace t = topics;
  expect_rows_in_order<t::Clock, t::CameraImage, t::CameraDepth, t::CameraInfo, t::WheelOdometry,
                       t::Imu, t::GnssFix, t::RobotOdometry, t::Transforms, t::StaticTransforms,
                       t::RobotDescription, t::Instances, t::Tracks, t::Plan, t::PlannerHeartbeat,
                       t::SpeedRequest, t::AxisState, t::AxisEvent, t::JointStates,
                       t::EmergencyStop, t::ToolReset, t::ToolEnable, t::Markers, t::TrueOdometry,
                       t::TrueField, t::TrueInstances, t::TrueSpray, t::RunStatus, t::RunRecord,
                       t::Diagnostics, t::Rosout>();
  EXPECT_EQ(topics::Plan::topic().name, "planner/plan");
  EXPECT_EQ(topics::Diagnostics::topic().name, "diagnostics");
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
