#include "furrow_msgs/enums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/idl_schema.hpp"
#include "furrow_msgs/message_types.hpp"

namespace furrow::msgs {
namespace {

/// Holds an enum class against the IDL: every value of an octet is a constant, or an error.
template <class Message>
void expect_as_in_the_idl(const std::string& name) {
  const auto schema = IdlSchema::parse(message_type<Message>().idl);
  ASSERT_TRUE(schema.ok()) << schema.error().message;
  ASSERT_TRUE(schema->is_enumeration("furrow_msgs::msg::" + name)) << name;
  const auto constants = schema->constants_of("furrow_msgs::msg::" + name);
  for (int number = 0; number < 256; ++number) {
    Message message;
    message.value(static_cast<std::uint8_t>(number));
    const auto value = from_msg(message);
    const auto it = std::ranges::find(constants, std::to_string(number), &IdlConstant::value);
    ASSERT_EQ(value.ok(), it != constants.end()) << name << " " << number;
    if (!value.ok()) {
      EXPECT_EQ(value.error().code, ErrorCode::kOutOfRange);
      EXPECT_EQ(value.error().message,
                "furrow_msgs/" + name + " has no value " + std::to_string(number));
      EXPECT_EQ(to_string(message), "unknown (" + std::to_string(number) + ")");
      continue;
    }
    std::string word = it->name;
    std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
    EXPECT_EQ(to_string(*value), word);
    EXPECT_EQ(to_string(message), word);
    EXPECT_EQ(to_msg(*value), message);
    EXPECT_TRUE(message == *value);
  }
}

TEST(Enums, MatchTheConstantsOfTheIdl) {
  expect_as_in_the_idl<furrow_msgs::msg::TrackState>("TrackState");
  expect_as_in_the_idl<furrow_msgs::msg::DecisionKind>("DecisionKind");
  expect_as_in_the_idl<furrow_msgs::msg::AxisEventKind>("AxisEventKind");
  expect_as_in_the_idl<furrow_msgs::msg::SafetyCause>("SafetyCause");
  expect_as_in_the_idl<furrow_msgs::msg::DriveState>("DriveState");
  expect_as_in_the_idl<furrow_msgs::msg::AxisMode>("AxisMode");
}

TEST(Enums, MessageWithoutContentIsNeitherADecisionNorAnEvent) {
  EXPECT_FALSE(from_msg(furrow_msgs::msg::DecisionKind()).ok());
  EXPECT_FALSE(from_msg(furrow_msgs::msg::AxisEventKind()).ok());
}

TEST(Enums, AreOneByteOfCdr) {
  furrow_msgs::msg::SafetyCause message = to_msg(SafetyCause::kValveFault);
  const MessageType& type = message_type<furrow_msgs::msg::SafetyCause>();
  std::vector<std::byte> bytes(type.serialized_size(&message));
  ASSERT_EQ(*type.serialize(&message, bytes), 5u);
  EXPECT_EQ(bytes[4], std::byte{10});
}

}  // namespace
}  // namespace furrow::msgs
