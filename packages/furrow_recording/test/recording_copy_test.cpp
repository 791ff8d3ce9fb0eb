#include "furrow_recording/recording_copy.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/tf2_msgs.h"
#include "furrow_recording/latched_messages.hpp"
#include "furrow_recording/recording_summary.hpp"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

/// Messages of topics that begin with "map" or are tf_static are latched.
class CopyInput {
 public:
  CopyInput() : writer_(std::move(mcap::Writer::open(mcap::memory_sink(bytes_)).value())) {}

  mcap::ChannelId channel(const TopicDescription& topic) {
    const auto schema = writer_->add_schema(topic.type_name, "ros2msg", "");
    return *writer_->add_channel(
        {0, *schema, topic_in_file(topic.name), topic.message_encoding, channel_metadata(topic)});
  }
  mcap::ChannelId channel(const std::string& name) {
    return channel(topic_of(name, name.starts_with("map")));
  }
  void message(mcap::ChannelId channel, std::int64_t ms, const std::vector<std::byte>& data) {
    EXPECT_TRUE(writer_->write({channel, 0, at_ms(ms), at_ms(ms), data}).ok());
  }
  void message(mcap::ChannelId channel, std::int64_t ms, int value) {
    message(channel, ms, {static_cast<std::byte>(value)});
  }
  mcap::Writer& writer() { return *writer_; }
  const Bytes& close() {
    EXPECT_TRUE(writer_->close().ok());
    return bytes_;
  }

 private:
  Bytes bytes_;
  std::unique_ptr<mcap::Writer> writer_;
};

struct Copied {
  Result<CopyReport> report;
  Bytes bytes;
};

Copied copy_of_input(CopyInput& input, const Selection& selection) {
  const auto reader = reader_of(input.close());
  Bytes bytes;
  auto writer = std::move(mcap::Writer::open(mcap::memory_sink(bytes)).value());
  auto report = copy_recording(*reader, *writer, selection);
  EXPECT_TRUE(writer->close().ok());
  EXPECT_EQ(mcap::verify(*mcap::memory_source(bytes))->faults, Lines());
  return {std::move(report), std::move(bytes)};
}

Bytes transforms_cdr(const Lines& children) {
  tf2_msgs::msg::TFMessage message;
  for (const std::string& child : children) {
    geometry_msgs::msg::TransformStamped transform;
    transform.child_frame_id(child);
    message.transforms().push_back(transform);
  }
  const msgs::MessageType& type = msgs::message_type<tf2_msgs::msg::TFMessage>();
  Bytes bytes(type.serialized_size(&message));
  bytes.resize(type.serialize(&message, bytes).value());
  return bytes;
}

Lines children_in(const Bytes& file) {
  Lines frames;
  const auto reader = reader_of(file);
  const auto stream = reader->messages({});
  for (auto next = stream->next(); next && *next; next = stream->next()) {
    tf2_msgs::msg::TFMessage message;
    EXPECT_TRUE(
        msgs::message_type<tf2_msgs::msg::TFMessage>().deserialize((*next)->data, &message).ok());
    std::string line;
    for (const auto& transform : message.transforms()) line += transform.child_frame_id() + " ";
    frames.push_back(line);
  }
  return frames;
}

TEST(RecordingCopy, ARangeBeginsWithTheLatchedMessageThatHolds) {
  CopyInput input;
  const auto map = input.channel("map");
  const auto pose = input.channel("pose");
  input.message(map, 10, 1);
  input.message(pose, 20, 2);
  input.message(map, 30, 3);
  for (int i = 0; i < 3; ++i) input.message(pose, 40 + 10 * i, 4 + i);
  Selection selection;
  selection.from_s = 0.03;
  selection.to_s = 0.05;
  const Copied copied = copy_of_input(input, selection);
  ASSERT_TRUE(copied.report.ok()) << copied.report.error().message;
  EXPECT_EQ(copied.report->latched, 1U);
  EXPECT_EQ(content_of(copied.bytes), (Lines{"/map@40=3", "/pose@40=4", "/pose@50=5"}));
}

TEST(RecordingCopy, StaticTransformsOfAllPublishersAreKept) {
  CopyInput input;
  TopicDescription topic = topic_of("tf_static", true);
  topic.type_name = "tf2_msgs/msg/TFMessage";
  const auto transforms = input.channel(topic);
  input.message(transforms, 1, transforms_cdr({"camera"}));
  input.message(transforms, 2, transforms_cdr({"imu"}));
  input.message(transforms, 3, transforms_cdr({"wheel_left", "wheel_right"}));
  input.message(transforms, 4, transforms_cdr({"camera", "camera_optical"}));  // replaces the first
  input.message(transforms, 5,
                transforms_cdr({"wheel_left"}));  // the right one has no later transform
  input.message(input.channel("pose"), 100, 1);
  Selection selection;
  selection.from_s = 0.05;
  selection.topics.include = {"tf_static"};
  const Copied copied = copy_of_input(input, selection);
  ASSERT_TRUE(copied.report.ok()) << copied.report.error().message;
  EXPECT_EQ(children_in(copied.bytes),
            (Lines{"imu ", "wheel_left wheel_right ", "camera camera_optical ", "wheel_left "}));
}

TEST(RecordingCopy, StaticTransformsWithoutQosAreLatchedByTheirName) {
  CopyInput input;
  TopicDescription topic = topic_of("robot/tf_static");
  topic.type_name = "tf2_msgs/msg/TFMessage";
  topic.offered_qos.clear();
  const auto transforms = input.channel(topic);
  input.message(transforms, 1, transforms_cdr({"camera"}));
  input.message(input.channel("pose"), 100, 1);
  Selection selection;
  selection.from_s = 0.05;
  const Copied copied = copy_of_input(input, selection);
  EXPECT_EQ(copied.report->latched, 1U);
}

TEST(RecordingCopy, OneLatchedMessageOfEachPublisherIsKept) {
  CopyInput input;
  // Three publishers in one channel, as rosbag2 writes them; two with channels of their own.
  TopicDescription shared = topic_of("map_shared", true);
  shared.offered_qos.resize(3, msgs::latched_qos());
  const auto of_three = input.channel(shared);
  for (int i = 0; i < 5; ++i) input.message(of_three, i, i);
  for (const char* publisher : {"a", "b"}) {
    TopicDescription own = topic_of("map", true);
    own.publisher = publisher;
    const auto channel = input.channel(own);
    input.message(channel, 10, 10);
    input.message(channel, 11, publisher[0]);
  }
  input.message(input.channel("pose"), 100, 1);
  Selection selection;
  selection.from_s = 0.05;
  const Copied copied = copy_of_input(input, selection);
  EXPECT_EQ(copied.report->latched, 5U);
  EXPECT_EQ(content_of(copied.bytes),
            (Lines{"/map_shared@50=2", "/map_shared@50=3", "/map_shared@50=4", "/map@50=97",
                   "/map@50=98", "/pose@100=1"}));
}

TEST(RecordingCopy, TopicsAreSelectedAndMisspelledPatternsTold) {
  CopyInput input;
  input.message(input.channel("a"), 1, 1);
  input.message(input.channel("b/c"), 2, 2);
  Selection selection;
  selection.topics = {{"/b/*", "typo"}, {"nothing"}};
  const Copied copied = copy_of_input(input, selection);
  ASSERT_TRUE(copied.report.ok());
  EXPECT_EQ(content_of(copied.bytes), Lines{"/b/c@2=2"});
  EXPECT_EQ(copied.report->unmatched_includes, Lines{"typo"});
  EXPECT_EQ(copied.report->unmatched_excludes, Lines{"nothing"});
  EXPECT_FALSE(copied.report->complete());
}

TEST(RecordingCopy, ASelectionThatCannotBeMetIsRefused) {
  CopyInput input;
  input.message(input.channel("a"), 1, 1);
  input.message(input.channel("b"), 1001, 1);
  const auto reader = reader_of(input.close());
  const auto refused = [&reader](const Selection& selection) {
    Bytes bytes;
    auto writer = std::move(mcap::Writer::open(mcap::memory_sink(bytes)).value());
    const auto report = copy_recording(*reader, *writer, selection);
    return !report.ok() && report.error().code == ErrorCode::kInvalidArgument;
  };
  EXPECT_TRUE(refused({.topics = {{"nosuch"}, {}}}));
  EXPECT_TRUE(refused({.topics = {{"*"}, {"*"}}}));
  EXPECT_TRUE(refused({.from_s = 1.5}));
  EXPECT_TRUE(refused({.from_s = -1.0}));
  EXPECT_TRUE(refused({.from_s = 0.5, .to_s = 0.5}));
  EXPECT_FALSE(refused({.from_s = 0.5, .to_s = 0.6}));
}

TEST(RecordingCopy, TheRateIsLimitedOfEachTopicButNotOfLatchedOnes) {
  CopyInput input;
  const auto fast = input.channel("fast");
  const auto slow = input.channel("slow");
  const auto map = input.channel("map");
  for (int i = 0; i < 100; ++i) input.message(fast, 10 * i, 1);
  for (int i = 0; i < 4; ++i) input.message(slow, 250 * i, 2);
  for (int i = 0; i < 20; ++i) input.message(map, i, 3);
  Selection selection;
  selection.max_hz = 10.0;
  const Copied copied = copy_of_input(input, selection);
  std::map<std::string, int> counts;
  for (const std::string& line : content_of(copied.bytes)) ++counts[line.substr(0, line.find('@'))];
  EXPECT_EQ(counts, (std::map<std::string, int>{{"/fast", 10}, {"/slow", 4}, {"/map", 20}}));
}

TEST(RecordingCopy, TopicsWithoutMessagesStayInTheFile) {
  CopyInput input;
  input.channel("silent");
  input.message(input.channel("a"), 1, 1);
  const Copied copied = copy_of_input(input, {});
  EXPECT_EQ(reader_of(copied.bytes)->info().summary.channels.size(), 2U);
}

class CopyFiles : public testing::Test {
 protected:
  void write(const std::string& name, CopyInput& input) const {
    const Bytes& bytes = input.close();
    std::ofstream(folder_.path() / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  Folder folder_;
};

TEST_F(CopyFiles, SeveralRecordingsAreMergedByTime) {
  for (int i = 0; i < 3; ++i) {
    CopyInput input;
    const auto shared = input.channel("shared");
    const auto own = input.channel("own" + std::to_string(i));
    for (int k = 0; k < 4; ++k) {
      input.message(shared, 10 * k + i, i);
      input.message(own, 10 * k + 5, i);
    }
    EXPECT_TRUE(input.writer().write(mcap::Metadata{"m" + std::to_string(i), {}}).ok());
    EXPECT_TRUE(input.writer().write(mcap::Attachment{at_ms(1), at_ms(1), "a", "", Bytes(3)}).ok());
    write(std::to_string(i) + ".mcap", input);
  }
  CopyJob job;
  for (const char* name : {"2.mcap", "0.mcap", "1.mcap"})
    job.inputs.push_back(folder_.path() / name);
  job.output = folder_.path() / "all.mcap";
  const auto report = run_copy(job);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_EQ(report->messages, 24U);
  EXPECT_EQ(report->metadata, 3U);
  EXPECT_EQ(report->attachments, 3U);
  const auto reader = std::move(open_recording(job.output).value());
  const auto topics = summarize_topics(reader->info());
  EXPECT_EQ(topics.size(), 4U);
  Time last;
  const auto stream = reader->messages({});
  for (auto next = stream->next(); next && *next; next = stream->next()) {
    EXPECT_LE(last, (*next)->log_time);
    last = (*next)->log_time;
  }
  EXPECT_EQ(verify_recording(job.output)->faults, Lines());
}

TEST_F(CopyFiles, TheOutputAppearsWholeOrNotAtAll) {
  CopyInput input;
  input.message(input.channel("a"), 1, 1);
  write("in.mcap", input);
  std::ofstream(folder_.path() / "kept.mcap") << "mine";
  CopyJob job;
  job.inputs = {folder_.path() / "in.mcap"};
  job.output = folder_.path() / "kept.mcap";
  EXPECT_EQ(run_copy(job).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(std::filesystem::file_size(job.output), 4U);
  job.output = folder_.path() / "out.mcap";
  job.selection.topics.include = {"nosuch"};
  EXPECT_FALSE(run_copy(job).ok());
  job.output = folder_.path() / "no" / "folder.mcap";
  job.selection = {};
  EXPECT_EQ(run_copy(job).error().code, ErrorCode::kIo);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    ++files;
  }
  EXPECT_EQ(files, 2U) << "nothing is left behind";
}

}  // namespace
}  // namespace furrow::recording
