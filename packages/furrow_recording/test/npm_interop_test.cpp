// Files are read, checked and decoded by the independent npm packages, and theirs by us.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/rosgraph_msgs.h"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_msgs/std_msgs.h"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

struct Outcome {
  int exit_code = -1;
  std::string output;
};

/// @pre no argument holds a quote.
Outcome run_node(const std::vector<std::string>& arguments) {
  std::string command = "NODE_PATH='" FURROW_NODE_MODULES "' node";
  for (const std::string& argument : arguments) {
    command += " '" + argument + "'";
  }
  command += " 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    return outcome;
  }
  std::array<char, 4096> buffer{};
  for (std::size_t got = 0; (got = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.output.append(buffer.data(), got);
  }
  outcome.exit_code = pclose(pipe);
  return outcome;
}

std::string script(const char* name) {
  return std::string(FURROW_TEST_DATA_DIR) + "/npm/" + name;
}

class NpmInterop : public testing::Test {
 protected:
  void SetUp() override {
    if (run_node({"-e", "require(\"@mcap/core\")"}).exit_code != 0) {
      GTEST_SKIP() << "node or the npm packages of test/npm are not there; with node and npm the "
                      "build installs them into " FURROW_NODE_MODULES;
    }
  }

  template <class Message>
  void record(Recorder& recorder, const std::string& name, Time time, const Message& message,
              SchemaStyle style) {
    const msgs::MessageType& type = msgs::message_type<Message>();
    const auto topic =
        recorder.add_topic(describe_topic(name, type.ros_name, {msgs::event_qos()}, style));
    Bytes bytes(type.serialized_size(&message));
    const auto size = type.serialize(&message, bytes);
    ASSERT_TRUE(size.ok());
    bytes.resize(*size);
    ASSERT_TRUE(
        recorder.write(topic, time, time, std::make_shared<const Bytes>(std::move(bytes))).ok());
  }

  Folder folder_;
};

TEST_F(NpmInterop, OurFilesAreReadCheckedAndDecoded) {
  std::vector<std::string> arguments = {script("read.cjs")};
  std::string expected;
  for (const char* compression : {"none", "lz4", "zstd"}) {
    for (const auto style : {SchemaStyle::kRos2msg, SchemaStyle::kOmgidl}) {
      const bool omgidl = style == SchemaStyle::kOmgidl;
      RecorderParameters parameters;
      parameters.compression = compression;
      parameters.chunk_kb = 4;
      parameters.min_free_mb = 0;
      const auto stem = folder_.path() / (std::string(compression) + (omgidl ? "_idl" : "_msg"));
      Recorder recorder(parameters, stem);
      for (int i = 0; i < 100; ++i) {
        std_msgs::msg::String text;
        text.data("text " + std::to_string(i) + std::string(100, 'x'));
        record(recorder, "text", at_ms(i), text, style);
        expected +=
            "/text " + std::to_string(i * 1'000'000) + " {\"data\":\"" + text.data() + "\"}\n";
      }
      rosgraph_msgs::msg::Clock clock;
      clock.clock().sec(12);
      clock.clock().nanosec(34);
      record(recorder, "clock", at_ms(200), clock, style);
      expected += "/clock 200000000 {\"clock\":{\"sec\":12,\"nanosec\":34}}\n";
      sensor_msgs::msg::RegionOfInterest box;
      box.x_offset(7);
      box.do_rectify(true);
      record(recorder, "box", at_ms(201), box, style);
      expected +=
          "/box 201000000 {\"x_offset\":7,\"y_offset\":0,\"height\":0,\"width\":0,"
          "\"do_rectify\":true}\n";
      sensor_msgs::msg::CompressedImage image;
      image.header().frame_id("camera");
      image.format("raw");
      image.data({1, 2, 255});
      record(recorder, "image", at_ms(202), image, style);
      expected +=
          "/image 202000000 "
          "{\"header\":{\"stamp\":{\"sec\":0,\"nanosec\":0},\"frame_id\":\"camera\"},\"format\":"
          "\"raw\",\"data\":[1,2,255]}\n";
      ASSERT_TRUE(recorder.stop().ok());
      arguments.push_back(recorder.status().files.front().string());
    }
  }
  const Outcome outcome = run_node(arguments);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, expected);
}

TEST_F(NpmInterop, TheirFilesAreReadByUs) {
  for (const char* layout : {"chunks", "loose"}) {
    for (const char* compression : {"none", "zstd"}) {
      const auto path = folder_.path() / (std::string(layout) + compression + ".mcap");
      const Outcome outcome =
          run_node({script("write.cjs"), path.string(), "300", layout, compression});
      ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
      const auto source = mcap::open_file(path);
      ASSERT_TRUE(source.ok());
      EXPECT_EQ(mcap::verify(**source)->faults, Lines{}) << layout << compression;
      const auto reader = mcap::Reader::open(std::move(mcap::open_file(path).value()));
      ASSERT_TRUE(reader.ok()) << reader.error().message;
      ASSERT_EQ(reader->summary().metadata.size(), 1U);
      EXPECT_EQ(reader->metadata(reader->summary().metadata.front())->values.at("writer"),
                "@mcap/core");
      EXPECT_EQ(reader->attachment(reader->summary().attachments.front())->name, "note");
      const auto& channel = reader->summary().channels.begin()->second;
      const auto topic =
          describe_channel(channel, &reader->summary().schemas.at(channel.schema_id));
      EXPECT_EQ(topic.name, "text");
      EXPECT_EQ(topic.type_name, "std_msgs/msg/String");
      EXPECT_TRUE(topic.latched());
      auto cursor = reader->messages();
      int count = 0;
      for (; true; ++count) {
        const auto next = cursor.next();
        ASSERT_TRUE(next.ok()) << next.error().message;
        if (!*next) {
          break;
        }
        std_msgs::msg::String text;
        ASSERT_TRUE(
            msgs::message_type<std_msgs::msg::String>().deserialize((*next)->data, &text).ok());
        EXPECT_EQ(text.data(), "text " + std::to_string(count));
        EXPECT_EQ((*next)->log_time, at_ms(count));
      }
      EXPECT_EQ(count, 300);
    }
  }
}

}  // namespace
}  // namespace furrow::recording
