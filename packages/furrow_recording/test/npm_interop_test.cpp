// The independent npm packages read, check and decode our files, and we read theirs. Bags that we
// convert hold the same messages as the packages read in the bags.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/rosgraph_msgs.h"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_msgs/std_msgs.h"
#include "furrow_recording/recording_copy.hpp"
#include "recording_test_support.hpp"
#include "test_bag.hpp"
#include "test_db3.hpp"

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

Lines sorted_lines(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  std::ranges::sort(lines);
  return lines;
}

class NpmBags : public NpmInterop {
 protected:
  void SetUp() override {
    NpmInterop::SetUp();
    if (!IsSkipped() && run_node({"-e", "require(\"@foxglove/rosbag\")"}).exit_code != 0) {
      GTEST_SKIP() << "the npm packages are older than test/npm/package.json: build again";
    }
  }

  /// What the packages read in a bag they must also read in what we make of it.
  void expect_same_messages(const std::filesystem::path& bag, const Lines& options = {}) {
    Lines arguments = {script("read_bag.cjs")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.push_back(bag.string());
    const Outcome theirs = run_node(arguments);
    ASSERT_EQ(theirs.exit_code, 0) << theirs.output;
    CopyJob job;
    job.inputs = {bag};
    job.output = folder_.path() / "converted.mcap";
    const auto report = run_copy(job);
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_TRUE(report->complete());
    const Outcome ours = run_node({script("read.cjs"), job.output.string()});
    ASSERT_EQ(ours.exit_code, 0) << ours.output;
    const Lines expected = sorted_lines(theirs.output);
    EXPECT_GT(expected.size(), 0U);
    EXPECT_EQ(report->messages, expected.size());
    // Not EXPECT_EQ: printing thousands of lines does not help.
    const Lines got = sorted_lines(ours.output);
    const auto [wrong, right] = std::ranges::mismatch(got, expected);
    EXPECT_EQ(wrong == got.end() ? "" : *wrong, right == expected.end() ? "" : *right);
    std::filesystem::remove(job.output);
  }

  void write(const std::string& name, const mcap::Bytes& bytes) const {
    std::ofstream(folder_.path() / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
};

TEST_F(NpmBags, ConvertedBagsHoldTheSameMessages) {
  for (const char* compression : {"none", "bz2", "lz4"}) {
    SCOPED_TRACE(compression);
    TestBag bag(compression);
    const auto info = bag.connect(
        "/camera_info", "sensor_msgs/CameraInfo",
        with_header("Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
                    "float64[] D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\n"
                    "uint32 binning_x\nuint32 binning_y\nRegionOfInterest roi\n") +
            std::string(80, '=') +
            "\nMSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 "
            "height\nuint32 width\nbool do_rectify\n");
    const auto joints = bag.connect("/joints", "sensor_msgs/JointState",
                                    with_header("Header header\nstring[] name\nfloat64[] position\n"
                                                "float64[] velocity\nfloat64[] effort\n"));
    for (std::uint32_t i = 0; i < 30; ++i) {
      Ros1Message camera;
      camera.header(i, i, 7, "optical").number<std::uint32_t>(480).number<std::uint32_t>(640);
      camera.text("plumb_bob").number<std::uint32_t>(2).number(0.25).number(-1e-9);
      for (int k = 0; k < 30; ++k) camera.number(i + 0.5 * k);
      for (std::uint32_t k = 0; k < 6; ++k) camera.number(k);
      bag.message(info, 100 + i, 5, camera.number<std::uint8_t>(i % 2).bytes);
      Ros1Message state;
      state.header(i, i, i, "").number<std::uint32_t>(2).text("a").text("bc");
      state.number<std::uint32_t>(1).number(1.5 * i).number<std::uint32_t>(0);
      bag.message(joints, 100 + i, 6, state.number<std::uint32_t>(0).bytes);
      if (i % 7 == 6) bag.end_chunk();
    }
    write("run.bag", bag.close());
    expect_same_messages(folder_.path() / "run.bag");
  }
}

TEST_F(NpmBags, ConvertedSqliteFilesHoldTheSameMessages) {
  const auto path = folder_.path() / "run.db3";
  {
    TestDb3 file(path, {.definitions = false});
    file.topic(1, "/a", "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n");
    file.topic(2, "/b", "[]");
    for (int i = 0; i < 50; ++i) {
      file.message(1 + i % 2, 1000 - 7 * i, "text " + std::to_string(i));
    }
  }
  expect_same_messages(path, {"--db3"});
}

TEST_F(NpmBags, RealBagsHoldTheSameMessages) {
  const char* const given = std::getenv("FURROW_DATA_DIR");
  const std::filesystem::path folder =
      std::filesystem::path(given != nullptr ? given
                                             : FURROW_TEST_DATA_DIR "/../../../../shared/data") /
      "robot_logs";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "no " << folder << "; set FURROW_DATA_DIR";
  }
  expect_same_messages(folder / "test1.bag");
  expect_same_messages(folder / "test2.bag");
}

}  // namespace
}  // namespace furrow::recording
