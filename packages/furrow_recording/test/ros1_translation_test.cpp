#include "ros1_translation.hpp"

#include <gtest/gtest.h>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_msgs/std_msgs.h"
#include "test_bag.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kNoLimit = 1u << 30;

Ros1Translator translator(const std::string& type, const std::string& definition) {
  auto made = Ros1Translator::make(type, definition, known_ros2_structs());
  EXPECT_TRUE(made.ok()) << (made ? "" : made.error().message);
  return std::move(made.value());
}

template <class Message>
Message translated(const Ros1Translator& translator, const Ros1Message& message) {
  mcap::Bytes cdr;
  const Status status = translator.translate(message.bytes, kNoLimit, cdr);
  EXPECT_TRUE(status.ok()) << (status ? "" : status.error().message);
  Message result;
  EXPECT_TRUE(msgs::message_type<Message>().deserialize(cdr, &result).ok());
  return result;
}

const std::string kImageDefinition = with_header(
    "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 "
    "step\nuint8[] data\n");

TEST(Ros1Translation, AnImageLosesItsSequenceNumberOnly) {
  const Ros1Translator image = translator("sensor_msgs/Image", kImageDefinition);
  EXPECT_EQ(image.type_name(), "sensor_msgs/msg/Image");
  EXPECT_EQ(image.notes(), std::vector<std::string>());
  Ros1Message message;
  message.header(77, 12, 34, "camera").number<std::uint32_t>(2).number<std::uint32_t>(3);
  message.text("mono8").number<std::uint8_t>(0).number<std::uint32_t>(3);
  message.number<std::uint32_t>(6);
  for (std::uint8_t i = 1; i <= 6; ++i) message.number(i);
  const auto result = translated<sensor_msgs::msg::Image>(image, message);
  EXPECT_EQ(result.header().stamp().sec(), 12);
  EXPECT_EQ(result.header().stamp().nanosec(), 34U);
  EXPECT_EQ(result.header().frame_id(), "camera");
  EXPECT_EQ(result.height(), 2U);
  EXPECT_EQ(result.encoding(), "mono8");
  EXPECT_EQ(result.data(), (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
}

TEST(Ros1Translation, FieldsThatRos2RenamedAreFoundByName) {
  const Ros1Translator info = translator(
      "sensor_msgs/CameraInfo",
      with_header("Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
                  "float64[] D\nfloat64[9]  K # 3x3\nfloat64[9]  R\nfloat64[12] P\n"
                  "uint32 binning_x\nuint32 binning_y\nRegionOfInterest roi\n") +
          std::string(80, '=') +
          "\nMSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 "
          "height\nuint32 width\nbool do_rectify\n");
  Ros1Message message;
  message.header(1, 2, 3, "optical").number<std::uint32_t>(480).number<std::uint32_t>(640);
  message.text("plumb_bob").number<std::uint32_t>(1).number(0.25);
  for (int i = 0; i < 30; ++i) message.number(static_cast<double>(i));
  for (int i = 0; i < 6; ++i) message.number<std::uint32_t>(10 + i);
  message.number<std::uint8_t>(1);
  const auto result = translated<sensor_msgs::msg::CameraInfo>(info, message);
  EXPECT_EQ(result.d(), std::vector<double>{0.25});
  EXPECT_EQ(result.k()[8], 8.0);
  EXPECT_EQ(result.p()[11], 29.0);
  EXPECT_EQ(result.binning_y(), 11U);
  EXPECT_EQ(result.roi().width(), 15U);
  EXPECT_TRUE(result.roi().do_rectify());
}

TEST(Ros1Translation, UnknownTypesFollowTheirDefinition) {
  const Ros1Translator thing = translator(
      "my_robot/Thing",
      with_header("# what it is\nuint8 FRONT=1\nstring NAME=a # b\nHeader head\nbyte b\nchar c\n"
                  "int64 big\nduration wait\nPart[] parts\nPart[2] pair\nstring[] words\n"
                  "bool flag\nfloat32 endValue\n") +
          std::string(80, '=') + "\nMSG: my_robot/Part\nint16 a\ntime when\nNothing none\n" +
          std::string(80, '=') + "\nMSG: my_robot/Nothing\n# no fields\n");
  EXPECT_EQ(thing.type_name(), "my_robot/msg/Thing");
  EXPECT_EQ(
      ros2_definition_text(thing.schema()),
      "uint8 FRONT=1\nstring NAME=a # b\nstd_msgs/Header head\nuint8 b\nuint8 c\nint64 big\n"
      "builtin_interfaces/Duration wait\nmy_robot/Part[] parts\nmy_robot/Part[2] pair\n"
      "string[] words\nbool flag\nfloat32 end_value\n" +
          std::string(80, '=') +
          "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
          std::string(80, '=') + "\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n" +
          std::string(80, '=') +
          "\nMSG: my_robot/Part\nint16 a\nbuiltin_interfaces/Time when\nmy_robot/Nothing none\n" +
          std::string(80, '=') + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" +
          std::string(80, '=') + "\nMSG: my_robot/Nothing\n");
  Ros1Message message;
  message.header(9, 1, 2, "f").number<std::int8_t>(-1).number<std::uint8_t>(200);
  message.number<std::int64_t>(-5).number<std::int32_t>(0).number<std::int32_t>(-500'000'000);
  message.number<std::uint32_t>(1);
  for (int i = 0; i < 3; ++i) {
    message.number<std::int16_t>(static_cast<std::int16_t>(i));
    message.number<std::uint32_t>(100).number<std::uint32_t>(7);
  }
  message.number<std::uint32_t>(2).text("ab").text("").number<std::uint8_t>(7).number(1.5F);
  mcap::Bytes cdr;
  ASSERT_TRUE(thing.translate(message.bytes, kNoLimit, cdr).ok());
  // By hand: XCDR1, little endian, aligned from behind the encapsulation header.
  Ros1Message expected;
  expected.number<std::uint32_t>(0x00000100);
  expected.number<std::uint32_t>(1).number<std::uint32_t>(2);            // 0: stamp
  expected.number<std::uint32_t>(2).number('f').number('\0');            // 8: frame_id
  expected.number<std::int8_t>(-1).number<std::uint8_t>(200);            // 14: b, c
  expected.number<std::int64_t>(-5);                                     // 16: big
  expected.number<std::int32_t>(-1).number<std::uint32_t>(500'000'000);  // 24: wait
  expected.number<std::uint32_t>(1);                                     // 32: parts
  for (std::int16_t i = 0; i < 3; ++i) {
    expected.number(i);
    if (i == 0) expected.number<std::uint16_t>(0);  // aligned by 4, as at 52 and 64
    expected.number<std::uint32_t>(100).number<std::uint32_t>(7);
    expected.number<std::uint8_t>(0);             // none
    if (i < 2) expected.number<std::uint8_t>(0);  // aligned by 2
  }
  expected.number<std::uint8_t>(0).number<std::uint16_t>(0);  // aligned by 4
  expected.number<std::uint32_t>(2);
  expected.number<std::uint32_t>(3).number('a').number('b').number('\0').number('\0');
  expected.number<std::uint32_t>(1).number('\0');
  expected.number<std::uint8_t>(1);  // flag
  expected.number<std::uint16_t>(0).number(1.5F);
  EXPECT_EQ(cdr, expected.bytes);
}

TEST(Ros1Translation, LogsHaveRos2sLevels) {
  const Ros1Translator log = translator(
      "rosgraph_msgs/Log", with_header("byte DEBUG=1\nHeader header\nbyte level\nstring name\n"
                                       "string msg\nstring file\nstring function\nuint32 line\n"
                                       "string[] topics\n"));
  EXPECT_EQ(log.type_name(), "rcl_interfaces/msg/Log");
  ASSERT_EQ(log.notes().size(), 2U) << "topics and the header's frame exist in ROS 1 only";
  Ros1Message message;
  message.header(1, 5, 6, "").number<std::uint8_t>(8).text("n").text("m").text("f").text("g");
  message.number<std::uint32_t>(42).number<std::uint32_t>(1).text("/rosout");
  mcap::Bytes cdr;
  ASSERT_TRUE(log.translate(message.bytes, kNoLimit, cdr).ok());
  EXPECT_EQ(cdr.at(4 + 8), std::byte{40}) << "ERROR";
}

TEST(Ros1Translation, OldTransformMessagesHaveTheirNewName) {
  const std::string transform =
      with_header("geometry_msgs/TransformStamped[] transforms\n") + std::string(80, '=') +
      "\nMSG: geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\nTransform "
      "transform\n" +
      std::string(80, '=') +
      "\nMSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n" +
      std::string(80, '=') + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" +
      std::string(80, '=') +
      "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
  EXPECT_EQ(translator("tf/tfMessage", transform).type_name(), "tf2_msgs/msg/TFMessage");
}

TEST(Ros1Translation, MessagesThatDoNotMatchAreRefused) {
  const Ros1Translator image = translator("sensor_msgs/Image", kImageDefinition);
  Ros1Message message;
  message.header(1, 2, 3, "camera").number<std::uint32_t>(1).number<std::uint32_t>(1);
  message.text("mono8").number<std::uint8_t>(0).number<std::uint32_t>(1);
  message.number<std::uint32_t>(1).number<std::uint8_t>(1);
  mcap::Bytes cdr;
  ASSERT_TRUE(image.translate(message.bytes, kNoLimit, cdr).ok());
  for (std::size_t size = 0; size < message.bytes.size(); ++size) {
    const auto part = std::span(message.bytes).first(size);
    EXPECT_EQ(image.translate(part, kNoLimit, cdr).error().code, ErrorCode::kParse) << size;
  }
  EXPECT_EQ(image.translate(message.bytes, 20, cdr).error().code, ErrorCode::kOutOfRange);
  message.number<std::uint8_t>(0);
  EXPECT_EQ(image.translate(message.bytes, kNoLimit, cdr).error().code, ErrorCode::kParse);
}

TEST(Ros1Translation, DefinitionsThatAreWrongAreRefused) {
  const std::string line(80, '=');
  for (const std::string& definition :
       {std::string("nonsense"), std::string("Missing m"), std::string("int32[x] a"),
        std::string("int32[0] a"), std::string("int32 a b c\nint32[ b"),
        "A a\n" + line + "\nMSG: p/A\nB b\n" + line + "\nMSG: p/B\nA a\n"}) {
    EXPECT_EQ(Ros1Translator::make("p/T", definition, {}).error().code, ErrorCode::kParse)
        << definition;
  }
}

TEST(Ros1Translation, EndlesslyNestedEmptyTypesEnd) {
  std::string definition = "T0 a\nT0 b\n";
  for (int i = 0; i < 60; ++i) {
    const std::string next = "T" + std::to_string(i + 1);
    definition += std::string(80, '=') + "\nMSG: p/T" + std::to_string(i) + "\n";
    if (i < 59) definition += next + "[4] a\n" + next + "[4] b\n";
  }
  const auto made = Ros1Translator::make("p/T", definition, {});
  ASSERT_TRUE(made.ok()) << made.error().message;
  mcap::Bytes cdr;
  EXPECT_EQ(made->translate({}, 1000, cdr).error().code, ErrorCode::kOutOfRange);
}

}  // namespace
}  // namespace furrow::recording
