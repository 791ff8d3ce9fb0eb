#include "furrow_recording/recording_export.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_msgs/std_msgs.h"
#include "image_files.hpp"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

constexpr char kRawImage[] = "sensor_msgs/msg/Image";

template <class Message>
Bytes serialized(const Message& message) {
  const msgs::MessageType& type = msgs::message_type<Message>();
  Bytes bytes(type.serialized_size(&message));
  bytes.resize(type.serialize(&message, bytes).value());
  return bytes;
}

sensor_msgs::msg::Image image_of(const std::string& encoding, std::uint32_t width,
                                 std::uint32_t height, std::vector<std::uint8_t> data) {
  sensor_msgs::msg::Image image;
  image.header().stamp().sec(7);
  image.header().stamp().nanosec(5);
  image.header().frame_id("optical");
  image.encoding(encoding);
  image.width(width);
  image.height(height);
  image.step(static_cast<std::uint32_t>(data.size() / height));
  image.data(std::move(data));
  return image;
}

/// The samples of a PNG file, in the order of their rows: 8 bit RGB(A) or grey, or 16 bit grey.
std::vector<int> samples_of(const std::vector<std::uint8_t>& png) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&header, png.data(), png.size()), 0);
  const bool deep = (header.format & PNG_FORMAT_FLAG_LINEAR) != 0;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(header));
  EXPECT_NE(png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr), 0);
  std::vector<int> samples;
  for (std::size_t i = 0; i < bytes.size(); i += deep ? 2 : 1) {
    samples.push_back(deep ? bytes[i] | bytes[i + 1] << 8 : bytes[i]);
  }
  return samples;
}

std::vector<int> decoded(const sensor_msgs::msg::Image& message) {
  const auto image = decode_image(kRawImage, serialized(message));
  EXPECT_TRUE(image.ok()) << (image ? "" : image.error().message);
  return image ? samples_of(image->png) : std::vector<int>();
}

TEST(ImageFiles, ColoursKeepTheirOrder) {
  using Values = std::vector<int>;
  EXPECT_EQ(decoded(image_of("rgb8", 2, 1, {1, 2, 3, 4, 5, 6})), (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(decoded(image_of("bgr8", 2, 1, {1, 2, 3, 4, 5, 6})), (Values{3, 2, 1, 6, 5, 4}));
  EXPECT_EQ(decoded(image_of("rgba8", 1, 1, {1, 2, 3, 200})), (Values{1, 2, 3, 200}));
  EXPECT_EQ(decoded(image_of("bgra8", 1, 1, {1, 2, 3, 200})), (Values{3, 2, 1, 200}));
  EXPECT_EQ(decoded(image_of("mono8", 2, 2, {1, 2, 3, 4})), (Values{1, 2, 3, 4}));
  // Rows may be padded.
  EXPECT_EQ(decoded(image_of("mono8", 1, 2, {1, 9, 3, 9})), (Values{1, 3}));
}

TEST(ImageFiles, DepthKeepsItsMillimetres) {
  using Values = std::vector<int>;
  auto depth = image_of("16UC1", 2, 1, {0x34, 0x12, 0xFF, 0xFF});
  EXPECT_EQ(decoded(depth), (Values{0x1234, 0xFFFF}));
  depth.is_bigendian(1);
  EXPECT_EQ(decoded(depth), (Values{0x3412, 0xFFFF}));
  const std::array<float, 4> metres = {1.5F, std::numeric_limits<float>::quiet_NaN(), -1.0F,
                                       100.0F};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(metres.data());
  EXPECT_EQ(decoded(image_of("32FC1", 4, 1, {bytes, bytes + sizeof metres})),
            (Values{1500, 0, 0, 65535}));
}

TEST(ImageFiles, BayerPatternsFindTheirColours) {
  // All pixels under one filter colour are bright: that colour alone is seen in the middle.
  struct Pattern {
    const char* encoding;
    int red_x, red_y;
  };
  for (const Pattern& pattern : {Pattern{"bayer_rggb8", 0, 0}, Pattern{"bayer_bggr8", 1, 1},
                                 Pattern{"bayer_gbrg8", 0, 1}, Pattern{"bayer_grbg8", 1, 0}}) {
    std::vector<std::uint8_t> data(64);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        data[static_cast<std::size_t>(8 * y + x)] =
            x % 2 == pattern.red_x && y % 2 == pattern.red_y ? 200 : 0;
      }
    }
    const auto samples = decoded(image_of(pattern.encoding, 8, 8, data));
    ASSERT_EQ(samples.size(), 192U);
    const std::size_t middle = 3 * (8 * 4 + 4);
    EXPECT_GT(samples[middle], 40) << pattern.encoding;
    EXPECT_EQ(samples[middle + 1], 0) << pattern.encoding;
    EXPECT_EQ(samples[middle + 2], 0) << pattern.encoding;
  }
}

TEST(ImageFiles, YuvBecomesColour) {
  // Y 81, U 90, V 240 is red in BT.601.
  for (const auto& [encoding, data] :
       {std::pair("yuv422_yuy2", std::vector<std::uint8_t>{81, 90, 81, 240}),
        std::pair("yuv422", std::vector<std::uint8_t>{90, 81, 240, 81})}) {
    const auto samples = decoded(image_of(encoding, 2, 1, data));
    ASSERT_EQ(samples.size(), 6U);
    EXPECT_NEAR(samples[0], 255, 3) << encoding;
    EXPECT_NEAR(samples[1], 0, 3) << encoding;
    EXPECT_NEAR(samples[2], 0, 3) << encoding;
  }
}

TEST(ImageFiles, CompressedImagesAreDecodedOrPassedOn) {
  std::vector<std::uint8_t> grey(64 * 64, 100);
  unsigned char* jpeg = nullptr;
  unsigned long bytes = 0;
  void* const compressor = tjInitCompress();
  ASSERT_EQ(
      tjCompress2(compressor, grey.data(), 64, 0, 64, TJPF_GRAY, &jpeg, &bytes, TJSAMP_GRAY, 95, 0),
      0);
  sensor_msgs::msg::CompressedImage message;
  message.format("mono8; jpeg compressed");
  message.data().assign(jpeg, jpeg + bytes);
  tjFree(jpeg);
  tjDestroy(compressor);
  constexpr char kType[] = "sensor_msgs/msg/CompressedImage";
  const auto image = decode_image(kType, serialized(message));
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width, 64);
  for (const int sample : samples_of(image->png)) ASSERT_NEAR(sample, 100, 2);
  message.data().resize(message.data().size() / 2);
  EXPECT_FALSE(decode_image(kType, serialized(message)).ok());
  message.data().assign(image->png.begin(), image->png.end());
  EXPECT_EQ(decode_image(kType, serialized(message))->png, image->png);
  message.data().assign({1, 2, 3, 4});
  EXPECT_EQ(decode_image(kType, serialized(message)).error().code, ErrorCode::kInvalidArgument);
}

TEST(ImageFiles, ImagesThatDoNotMatchTheirSizeAreRefused) {
  auto image = image_of("rgb8", 2, 2, std::vector<std::uint8_t>(12));
  image.step(5);
  EXPECT_EQ(decode_image(kRawImage, serialized(image)).error().code, ErrorCode::kParse);
  image.step(6);
  image.height(3);
  EXPECT_EQ(decode_image(kRawImage, serialized(image)).error().code, ErrorCode::kParse);
  image.height(0xFFFFFFFF);
  image.step(0xFFFFFFFF);
  EXPECT_EQ(decode_image(kRawImage, serialized(image)).error().code, ErrorCode::kParse);
  image = image_of("yuv420_planar", 2, 2, std::vector<std::uint8_t>(6));
  EXPECT_EQ(decode_image(kRawImage, serialized(image)).error().code, ErrorCode::kInvalidArgument);
}

class Export : public testing::Test {
 protected:
  Export() : writer_(std::move(mcap::Writer::open(mcap::memory_sink(bytes_)).value())) {}

  template <class Message>
  void add(const std::string& topic, std::int64_t ms, const Message& message,
           const std::string& encoding = "cdr") {
    TopicDescription description = describe_topic(topic, msgs::message_type<Message>().ros_name,
                                                  {msgs::event_qos()}, SchemaStyle::kRos2msg);
    description.message_encoding = encoding;
    const auto [at, added] = channels_.try_emplace(topic);
    if (added) {
      const auto schema = writer_->add_schema(description.type_name, description.schema_encoding,
                                              description.schema_text);
      at->second =
          *writer_->add_channel({0, *schema, topic_in_file(topic), description.message_encoding,
                                 channel_metadata(description)});
    }
    const Bytes cdr = serialized(message);
    ASSERT_TRUE(writer_->write({at->second, 0, at_ms(ms), at_ms(ms), cdr}).ok());
  }

  Result<ExportReport> run(const ExportOptions& options = {}) {
    EXPECT_TRUE(writer_->close().ok());
    return export_recording(*reader_of(bytes_), folder_.path() / "out", options);
  }
  [[nodiscard]] std::string content(const std::string& file) const {
    std::ifstream stream(folder_.path() / "out" / file, std::ios::binary);
    EXPECT_TRUE(stream) << file;
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  Folder folder_;
  Bytes bytes_;
  std::unique_ptr<mcap::Writer> writer_;
  std::map<std::string, mcap::ChannelId> channels_;
};

TEST_F(Export, TopicsBecomeTablesAndImagesFrames) {
  std_msgs::msg::String text;
  text.data("a,b");
  add("robot/say", 1000, text);
  add("robot_say", 1001, text);
  add("camera/image", 1002, image_of("rgb8", 2, 1, {1, 2, 3, 4, 5, 6}));
  add("camera/image", 1003, image_of("rgb8", 2, 1, {9, 9, 9, 9, 9, 9}));
  const auto report = run();
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_TRUE(report->complete());
  EXPECT_EQ(report->images, 2U);
  EXPECT_EQ(content("robot_say.csv"),
            "log_time_ns,publish_time_ns,data\r\n1000000000,1000000000,\"a,b\"\r\n");
  EXPECT_EQ(content("robot_say_2.csv"),
            "log_time_ns,publish_time_ns,data\r\n1001000000,1001000000,\"a,b\"\r\n");
  const auto coco = nlohmann::json::parse(content("frames.json"));
  ASSERT_EQ(coco["images"].size(), 2U);
  const auto& frame = coco["images"][0];
  EXPECT_EQ(frame["id"], 1);
  EXPECT_EQ(frame["file_name"], "camera_image/000000_7000000005.png");
  EXPECT_EQ(frame["width"], 2);
  EXPECT_EQ(frame["topic"], "camera/image");
  EXPECT_EQ(frame["stamp_ns"], 7'000'000'005);
  EXPECT_EQ(frame["frame_id"], "optical");
  EXPECT_TRUE(coco["annotations"].empty());
  const std::string png = content(frame["file_name"]);
  EXPECT_EQ(samples_of({png.begin(), png.end()}), (std::vector<int>{1, 2, 3, 4, 5, 6}));
}

TEST_F(Export, WhatCannotBeExportedIsTold) {
  std_msgs::msg::String text;
  add("json", 1, text, "json");
  add("camera/image", 2, image_of("nv21", 2, 2, std::vector<std::uint8_t>(6)));
  add("good", 3, text);
  const auto report = run();
  ASSERT_TRUE(report.ok());
  EXPECT_FALSE(report->complete());
  ASSERT_EQ(report->topics.size(), 3U);
  EXPECT_EQ(report->topics[0].left_out, 1U);
  EXPECT_NE(report->topics[0].reason.find("json"), std::string::npos);
  EXPECT_NE(report->topics[1].reason.find("nv21"), std::string::npos);
  EXPECT_EQ(report->topics[2].written, 1U);
}

TEST_F(Export, ARangeAndSomeTopicsAreExported) {
  std_msgs::msg::String text;
  for (int i = 0; i < 10; ++i) {
    add("a", 100 * i, text);
    add("b", 100 * i, text);
  }
  ExportOptions options;
  options.topics.include = {"a", "typo"};
  options.from_s = 0.2;
  options.to_s = 0.5;
  const auto report = run(options);
  ASSERT_TRUE(report.ok());
  ASSERT_EQ(report->topics.size(), 1U);
  EXPECT_EQ(report->topics[0].written, 3U);
  EXPECT_EQ(report->unmatched_includes, Lines{"typo"});
}

TEST_F(Export, TheFolderAppearsWholeOrNotAtAll) {
  std_msgs::msg::String text;
  add("a", 1, text);
  std::filesystem::create_directory(folder_.path() / "out");
  EXPECT_EQ(run().error().code, ErrorCode::kInvalidArgument);
  std::filesystem::remove(folder_.path() / "out");
  ExportOptions options;
  options.topics.include = {"nosuch"};
  EXPECT_EQ(export_recording(*reader_of(bytes_), folder_.path() / "out", options).error().code,
            ErrorCode::kInvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace furrow::recording
