#include "furrow_recording/topic_description.hpp"

#include <gtest/gtest.h>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::recording {
namespace {

using msgs::Durability;
using msgs::Reliability;

bool same(const msgs::Qos& a, const msgs::Qos& b) {
  return a.reliability == b.reliability && a.durability == b.durability && a.depth == b.depth &&
         a.deadline == b.deadline && a.liveliness_lease == b.liveliness_lease &&
         a.lifespan == b.lifespan;
}

TEST(Names, TopicsGoBothWays) {
  for (const char* name : {"camera/image", "//foreign", "//ns/foreign"}) {
    EXPECT_EQ(topic_from_file(topic_in_file(name)), name);
  }
  EXPECT_EQ(topic_in_file("camera/image"), "/camera/image");
  EXPECT_EQ(topic_from_file("rt/chatter"), "chatter");
}

TEST(QosText, GoesBothWays) {
  msgs::Qos watched;
  watched.deadline = Duration::milliseconds(250);
  watched.liveliness_lease = Duration::seconds(3);
  watched.lifespan = Duration::seconds(10);
  const std::vector<msgs::Qos> profiles = {
      msgs::latched_qos(), watched, {.reliability = Reliability::kBestEffort, .depth = 1}};
  const auto read = qos_from_yaml(qos_to_yaml(profiles));
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->size(), profiles.size());
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    EXPECT_TRUE(same((*read)[i], profiles[i])) << i;
  }
}

TEST(QosText, ReadsWhatOthersWrite) {
  const auto words = qos_from_yaml(
      "- history: keep_last\n  depth: 5\n  reliability: best_effort\n"
      "  durability: transient_local\n  deadline:\n    sec: 0\n    nsec: 0\n");
  ASSERT_TRUE(words.ok());
  ASSERT_EQ(words->size(), 1U);
  EXPECT_TRUE(same(words->front(), {.reliability = Reliability::kBestEffort,
                                    .durability = Durability::kTransientLocal,
                                    .depth = 5}));
  const auto flags =
      qos_from_yaml("reliability: true\ndurability: true\nownership: false\nkeyed: false\n");
  ASSERT_TRUE(flags.ok());
  ASSERT_EQ(flags->size(), 1U);
  EXPECT_EQ(flags->front().reliability, Reliability::kReliable);
  EXPECT_EQ(flags->front().durability, Durability::kTransientLocal);
  EXPECT_TRUE(qos_from_yaml("")->empty());
}

TEST(QosText, MalformedTextIsAnError) {
  EXPECT_EQ(qos_from_yaml("- [1, 2").error().code, ErrorCode::kParse);
  EXPECT_EQ(qos_from_yaml("- 7").error().code, ErrorCode::kParse);
  EXPECT_EQ(qos_from_yaml("text").error().code, ErrorCode::kParse);
  EXPECT_EQ(qos_from_yaml(std::string(100'000, '[')).error().code, ErrorCode::kParse);
  EXPECT_EQ(qos_from_yaml(std::string(60'000, '[')).error().code, ErrorCode::kParse);
}

TEST(Channels, SayWhatWasDescribed) {
  for (const auto style : {SchemaStyle::kRos2msg, SchemaStyle::kOmgidl}) {
    const auto topic = describe_topic("robot_description", "std_msgs::msg::dds_::String_",
                                      {msgs::latched_qos()}, style);
    EXPECT_TRUE(topic.latched());
    EXPECT_EQ(topic.type_name, "std_msgs/msg/String");
    const mcap::Schema schema{1, schema_name(topic), topic.schema_encoding, topic.schema_text};
    const mcap::Channel channel{1, 1, topic_in_file(topic.name), topic.message_encoding,
                                channel_metadata(topic)};
    const auto read = describe_channel(channel, &schema);
    EXPECT_EQ(read.name, topic.name);
    EXPECT_EQ(read.type_name, topic.type_name);
    EXPECT_EQ(read.schema_encoding, topic.schema_encoding);
    EXPECT_EQ(read.schema_text, topic.schema_text);
    EXPECT_TRUE(read.latched());
    ASSERT_EQ(read.offered_qos.size(), 1U);
    EXPECT_TRUE(same(read.offered_qos.front(), msgs::latched_qos()));
  }
}

TEST(Channels, UnknownTypesKeepTheirNames) {
  const auto topic =
      describe_topic("//thing", "someones::Thing", {msgs::event_qos()}, SchemaStyle::kRos2msg);
  EXPECT_EQ(topic.schema_encoding, "");
  EXPECT_EQ(topic.schema_text, "");
  const mcap::Schema schema{1, schema_name(topic), "", ""};
  const mcap::Channel channel{1, 1, topic_in_file(topic.name), "cdr", channel_metadata(topic)};
  EXPECT_EQ(describe_channel(channel, &schema).type_name, "someones::Thing");
  EXPECT_EQ(describe_channel(channel, &schema).name, "//thing");
  const auto bare = describe_channel({1, 0, "/x", "cdr", {{"qos", "- ["}}}, nullptr);
  EXPECT_EQ(bare.name, "x");
  EXPECT_TRUE(bare.offered_qos.empty());
}

TEST(Schemas, EveryTypeOfFurrowBecomesARos2Message) {
  for (const msgs::MessageType* type : msgs::all_message_types()) {
    const auto topic = describe_topic("a", type->ros_name, {}, SchemaStyle::kRos2msg);
    EXPECT_EQ(topic.schema_encoding, "ros2msg") << type->ros_name;
  }
  EXPECT_EQ(describe_topic("a", "rosgraph_msgs/msg/Clock", {}, SchemaStyle::kRos2msg).schema_text,
            "builtin_interfaces/Time clock\n" + std::string(80, '=') +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
  const auto info = describe_topic("a", "sensor_msgs/msg/CameraInfo", {}, SchemaStyle::kRos2msg);
  for (const char* line : {"float64[] d\n", "float64[12] p\n", "std_msgs/Header header\n",
                           "MSG: sensor_msgs/RegionOfInterest\n", "bool do_rectify\n"}) {
    EXPECT_NE(info.schema_text.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace furrow::recording
