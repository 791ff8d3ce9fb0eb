#include "furrow_recording/cdr_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_recording/topic_description.hpp"
#include "recording_test_support.hpp"
#include "test_bag.hpp"

namespace furrow::recording {
namespace {

template <class Message>
Bytes cdr_of(const Message& message) {
  const msgs::MessageType& type = msgs::message_type<Message>();
  Bytes bytes(type.serialized_size(&message));
  bytes.resize(type.serialize(&message, bytes).value());
  return bytes;
}

CdrTable table_of(const std::string& type, SchemaStyle style) {
  const TopicDescription topic = describe_topic("x", type, {}, style);
  auto schema = parse_schema_text(topic.schema_encoding, topic.schema_text, topic.type_name);
  EXPECT_TRUE(schema.ok()) << (schema ? "" : schema.error().message);
  return std::move(CdrTable::make(std::move(*schema)).value());
}

std::string cell(const CdrTable& table, const std::vector<std::string>& row,
                 const std::string& column) {
  const auto at = std::ranges::find(table.columns(), column);
  EXPECT_NE(at, table.columns().end()) << column;
  return at == table.columns().end()
             ? ""
             : row.at(static_cast<std::size_t>(at - table.columns().begin()));
}

TEST(CdrTable, StructsAndArraysAreFlattenedByBothKindsOfSchema) {
  nav_msgs::msg::Odometry odometry;
  odometry.header().stamp().sec(12);
  odometry.header().frame_id("odom, \"quoted\"");
  odometry.pose().pose().position().x(1.25);
  odometry.pose().covariance()[35] = std::numeric_limits<double>::infinity();
  odometry.twist().twist().angular().z(-0.1);
  for (const auto style : {SchemaStyle::kRos2msg, SchemaStyle::kOmgidl}) {
    const CdrTable table = table_of("nav_msgs/msg/Odometry", style);
    // stamp 2, frames 2, pose 7 and 36, twist 6 and 36.
    EXPECT_EQ(table.columns().size(), 89U);
    const auto row = table.row(cdr_of(odometry));
    ASSERT_TRUE(row.ok()) << row.error().message;
    ASSERT_EQ(row->size(), 89U);
    EXPECT_EQ(cell(table, *row, "header.stamp.sec"), "12");
    EXPECT_EQ(cell(table, *row, "header.frame_id"), "odom, \"quoted\"");
    EXPECT_EQ(cell(table, *row, "pose.pose.position.x"), "1.25");
    EXPECT_EQ(cell(table, *row, "pose.covariance[35]"), "inf");
    EXPECT_EQ(cell(table, *row, "twist.twist.angular.z"), "-0.1");
  }
}

TEST(CdrTable, SequencesAreJson) {
  sensor_msgs::msg::JointState joints;
  joints.name({"a\"b", "c"});
  joints.position({1.5, std::numeric_limits<double>::quiet_NaN()});
  const CdrTable table = table_of("sensor_msgs/msg/JointState", SchemaStyle::kRos2msg);
  const auto row = table.row(cdr_of(joints));
  ASSERT_TRUE(row.ok());
  EXPECT_EQ(cell(table, *row, "name"), R"(["a\"b","c"])");
  EXPECT_EQ(cell(table, *row, "position"), "[1.5,null]");
  EXPECT_EQ(cell(table, *row, "velocity"), "[]");
}

TEST(CdrTable, LongBytesAreMeasured) {
  sensor_msgs::msg::Image image;
  image.data().resize(1000);
  const CdrTable table = table_of("sensor_msgs/msg/Image", SchemaStyle::kRos2msg);
  EXPECT_EQ(cell(table, table.row(cdr_of(image)).value(), "data"), "1000 bytes");
}

TEST(CdrTable, BigEndianMessagesAreRead) {
  auto schema = parse_message_definition("uint16 a\nint32 b\nstring c\n", "p/T", RosVersion::kRos2);
  const CdrTable table = std::move(CdrTable::make(std::move(*schema)).value());
  Bytes cdr;
  for (const int byte : {0, 0, 0, 0, 1, 2, 0, 0, 0xFF, 0xFF, 0xFF, 0xFE, 0, 0, 0, 2, 0x78, 0}) {
    cdr.push_back(static_cast<std::byte>(byte));
  }
  EXPECT_EQ(table.row(cdr).value(), (std::vector<std::string>{"258", "-2", "x"}));
}

TEST(CdrTable, MessagesThatDoNotMatchAreRefused) {
  const CdrTable table = table_of("sensor_msgs/msg/JointState", SchemaStyle::kRos2msg);
  sensor_msgs::msg::JointState joints;
  joints.name({"a"});
  joints.position({1.0});
  Bytes cdr = cdr_of(joints);
  for (std::size_t size = 0; size < cdr.size(); ++size) {
    EXPECT_EQ(table.row(std::span(cdr).first(size)).error().code, ErrorCode::kParse) << size;
  }
  cdr.resize(cdr.size() + 4);
  EXPECT_EQ(table.row(cdr).error().code, ErrorCode::kParse);
  cdr[1] = std::byte{3};  // a parameter list
  EXPECT_EQ(table.row(cdr).error().code, ErrorCode::kParse);
}

TEST(CdrTable, TypesWithEndlessColumnsAreJsonOrRefused) {
  std::string nested = "T0 a\n";
  for (int i = 0; i < 40; ++i) {
    const std::string next = "T" + std::to_string(i + 1);
    nested += std::string(80, '=') + "\nMSG: p/T" + std::to_string(i) + "\n";
    nested += i < 39 ? next + " a\n" + next + " b\n" : "int32 x\n";
  }
  auto schema = parse_message_definition(nested, "p/T", RosVersion::kRos2);
  ASSERT_TRUE(schema.ok()) << schema.error().message;
  const auto table = CdrTable::make(std::move(*schema));
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(table->columns().size(), 1U);
  EXPECT_FALSE(table->row(Bytes{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}}).ok());
  std::string wide;
  for (int i = 0; i < 5000; ++i) wide += "int8 f" + std::to_string(i) + "\n";
  schema = parse_message_definition(wide, "p/T", RosVersion::kRos2);
  EXPECT_EQ(CdrTable::make(std::move(*schema)).error().code, ErrorCode::kOutOfRange);
}

TEST(CdrTable, CsvIsQuotedWhereItMustBe) {
  EXPECT_EQ(csv_line({"a", "b c", "1,5", "say \"x\"", "two\nlines", ""}),
            "a,b c,\"1,5\",\"say \"\"x\"\"\",\"two\nlines\",\r\n");
}

}  // namespace
}  // namespace furrow::recording
