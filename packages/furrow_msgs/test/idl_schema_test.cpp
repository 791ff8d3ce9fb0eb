#include "furrow_msgs/idl_schema.hpp"

#include <gtest/gtest.h>

#include "furrow_core/random.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::msgs {
namespace {

std::string cpp_name(std::string_view ros_name) {
  std::string name(ros_name);
  for (auto at = name.find('/'); at != std::string::npos; at = name.find('/')) {
    name.replace(at, 1, "::");
  }
  return name;
}

template <class Message>
std::vector<std::byte> serialized(const Message& message) {
  const MessageType& type = message_type<Message>();
  std::vector<std::byte> bytes(type.serialized_size(&message));
  bytes.resize(*type.serialize(&message, bytes));
  return bytes;
}

TEST(IdlSchema, ParsesEveryMessageType) {
  for (const MessageType* type : all_message_types()) {
    const auto schema = IdlSchema::parse(type->idl);
    ASSERT_TRUE(schema.ok()) << type->ros_name << ": " << schema.error().message;
    const std::string name = cpp_name(type->ros_name);
    ASSERT_NE(schema->find(name), nullptr) << name;
    const auto message = type->create();
    std::vector<std::byte> bytes(type->serialized_size(message.get()));
    bytes.resize(*type->serialize(message.get(), bytes));
    const auto text = print_cdr(*schema, name, bytes);
    EXPECT_TRUE(text.ok()) << type->ros_name;
  }
}

TEST(IdlSchema, PrintsNestedMessages) {
  furrow_msgs::msg::Plan plan;
  plan.header().stamp().sec(3);
  plan.header().frame_id("field");
  plan.revision(7);
  plan.routes().resize(1);
  plan.routes()[0].axis("axis_1");
  plan.routes()[0].stops().resize(1);
  plan.routes()[0].stops()[0].aim().y(-0.25);
  plan.routes()[0].stops()[0].track_ids({4, 5});
  const auto schema = IdlSchema::parse(message_type<furrow_msgs::msg::Plan>().idl);
  ASSERT_TRUE(schema.ok());
  const auto text = print_cdr(*schema, "furrow_msgs::msg::Plan", serialized(plan));
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(*text,
            "header:\n"
            "  stamp:\n"
            "    sec: 3\n"
            "    nanosec: 0\n"
            "  frame_id: \"field\"\n"
            "revision: 7\n"
            "routes:\n"
            "-\n"
            "  axis: \"axis_1\"\n"
            "  stops:\n"
            "  -\n"
            "    id: 0\n"
            "    aim:\n"
            "      x: 0\n"
            "      y: -0.25\n"
            "      z: 0\n"
            "    axis_position_m: 0\n"
            "    expected:\n"
            "      sec: 0\n"
            "      nanosec: 0\n"
            "    observed:\n"
            "      sec: 0\n"
            "      nanosec: 0\n"
            "    while_moving: false\n"
            "    track_ids: [4, 5]\n"
            "decisions: []\n");
}

TEST(IdlSchema, ConstantsBelongToTheirStruct) {
  const auto schema = IdlSchema::parse(
      "module a { module B_Constants { const uint8 X = 3; const long Y = -1; };\n"
      "struct B { uint8 value; }; struct C { a::B b; uint8 value; }; };");
  ASSERT_TRUE(schema.ok()) << schema.error().message;
  ASSERT_EQ(schema->constants_of("a::B").size(), 2u);
  EXPECT_EQ(schema->constants_of("a::B")[0].name, "X");
  EXPECT_EQ(schema->constants_of("a::B")[1].value, "-1");
  EXPECT_TRUE(schema->is_enumeration("a::B"));
  EXPECT_FALSE(schema->is_enumeration("a::C"));
  EXPECT_TRUE(schema->constants_of("a::C").empty());
}

TEST(IdlSchema, PrintsEnumerationsWithTheirNames) {
  furrow_msgs::msg::AxisEvent event;
  event.event(to_msg(AxisEventKind::kSafeState));
  event.cause().value(200);
  const auto schema = IdlSchema::parse(message_type<furrow_msgs::msg::AxisEvent>().idl);
  ASSERT_TRUE(schema.ok());
  const auto text = print_cdr(*schema, "furrow_msgs::msg::AxisEvent", serialized(event));
  ASSERT_TRUE(text.ok());
  EXPECT_NE(text->find("event: 7 (SAFE_STATE)\n"), std::string::npos) << *text;
  EXPECT_NE(text->find("cause: 200 (unknown)\n"), std::string::npos) << *text;
}

TEST(IdlSchema, LongSequenceIsTruncatedWithItsLength) {
  sensor_msgs::msg::Image image;
  image.data(std::vector<std::uint8_t>(1000, 9));
  const auto schema = IdlSchema::parse(message_type<sensor_msgs::msg::Image>().idl);
  ASSERT_TRUE(schema.ok());
  const auto text =
      print_cdr(*schema, "sensor_msgs::msg::Image", serialized(image), {.max_elements = 2});
  ASSERT_TRUE(text.ok());
  EXPECT_NE(text->find("data: [9, 9, ... 1000 in all]"), std::string::npos) << *text;
}

TEST(IdlSchema, FaultNamesTheLine) {
  const auto error = [](std::string_view idl) {
    const auto schema = IdlSchema::parse(idl);
    return schema.ok() ? std::string() : schema.error().message;
  };
  EXPECT_EQ(error("module a {\n struct B { c::D d; };\n};"), "IDL line 2: type 'c::D' is unknown");
  EXPECT_EQ(error("module a { struct B { long x[0]; }; };"),
            "IDL line 1: '0' is not the size of an array");
  EXPECT_EQ(error("module a {\n const uint8 B = 1;\n};"),
            "IDL line 2: a constant must be in a module NAME_Constants");
  EXPECT_EQ(error("module B_Constants { const string C = \"x\"; };"),
            "IDL line 1: a constant of type 'string' is not supported");
  EXPECT_EQ(error("union X {};"), "IDL line 1: 'union' is not supported");
  EXPECT_EQ(error("module a { struct B {"), "IDL line 1: unexpected end of the text");
}

TEST(IdlSchema, DamagedMessageOrTextNeverCrashes) {
  furrow_msgs::msg::Tracks tracks;
  tracks.tracks().resize(3);
  const auto bytes = serialized(tracks);
  const std::string idl(message_type<furrow_msgs::msg::Tracks>().idl);
  const auto schema = IdlSchema::parse(idl);
  ASSERT_TRUE(schema.ok());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(print_cdr(*schema, "furrow_msgs::msg::Tracks", std::span(bytes).first(size)).ok());
  }
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    auto damaged = bytes;
    damaged[static_cast<std::size_t>(
        random.integer(0, static_cast<std::int64_t>(bytes.size()) - 1))] =
        static_cast<std::byte>(random.integer(0, 255));
    (void)print_cdr(*schema, "furrow_msgs::msg::Tracks", damaged);
    std::string text = idl;
    text.resize(static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(idl.size()))));
    (void)IdlSchema::parse(text);
  }
}

}  // namespace
}  // namespace furrow::msgs
