#include "furrow_msgs/message_type.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/std_msgs.h"

namespace furrow::msgs {
namespace {

std::vector<std::byte> serialized(const MessageType& type, const void* message) {
  std::vector<std::byte> bytes(type.serialized_size(message));
  const auto size = type.serialize(message, bytes);
  EXPECT_TRUE(size.ok());
  bytes.resize(*size);
  return bytes;
}

TEST(MessageType, NamesAreThoseOfRos2) {
  const MessageType& type = message_type<std_msgs::msg::Header>();
  EXPECT_EQ(type.dds_name, "std_msgs::msg::dds_::Header_");
  EXPECT_EQ(type.ros_name, "std_msgs/msg/Header");
  EXPECT_NE(type.idl.find("module builtin_interfaces"), std::string_view::npos);
}

TEST(MessageType, CdrIsLittleEndianWithHeader) {
  std_msgs::msg::String message;
  message.data("ab");
  const auto bytes = serialized(message_type<std_msgs::msg::String>(), &message);
  const unsigned char expected[] = {0, 1, 0, 0, 3, 0, 0, 0, 'a', 'b', 0};
  ASSERT_EQ(bytes.size(), sizeof expected);
  EXPECT_EQ(std::memcmp(bytes.data(), expected, sizeof expected), 0);
}

TEST(MessageType, RoundTrip) {
  furrow_msgs::msg::Plan plan;
  plan.revision(7);
  plan.routes().resize(2);
  plan.routes()[1].axis("axis_2");
  plan.routes()[1].stops().resize(1);
  plan.routes()[1].stops()[0].track_ids({4, 5});
  const MessageType& type = message_type<furrow_msgs::msg::Plan>();
  const auto bytes = serialized(type, &plan);
  const auto copy = std::static_pointer_cast<furrow_msgs::msg::Plan>(type.create());
  ASSERT_TRUE(type.deserialize(bytes, copy.get()).ok());
  EXPECT_TRUE(*copy == plan);
}

TEST(MessageType, TruncatedAtAnyByteIsAnErrorOrShorter) {
  furrow_msgs::msg::Tracks tracks;
  tracks.header().frame_id("field");
  tracks.tracks().resize(3);
  const MessageType& type = message_type<furrow_msgs::msg::Tracks>();
  auto bytes = serialized(type, &tracks);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    furrow_msgs::msg::Tracks out;
    EXPECT_FALSE(type.deserialize(std::span(bytes).first(size), &out).ok()) << size;
  }
}

TEST(MessageType, TooSmallABufferIsAnError) {
  std_msgs::msg::String message;
  message.data("abcdef");
  std::vector<std::byte> bytes(8);
  const auto size = message_type<std_msgs::msg::String>().serialize(&message, bytes);
  ASSERT_FALSE(size.ok());
  EXPECT_EQ(size.error().code, ErrorCode::kOutOfRange);
}

}  // namespace
}  // namespace furrow::msgs
