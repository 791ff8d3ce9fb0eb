#include <gtest/gtest.h>

#include "mcap_test_support.hpp"

namespace furrow::mcap {
namespace {

class RoundTrip : public testing::TestWithParam<Compression> {};
INSTANTIATE_TEST_SUITE_P(Compressions, RoundTrip,
                         testing::Values(Compression::kNone, Compression::kLz4,
                                         Compression::kZstd));

TEST_P(RoundTrip, RandomMessagesComeBackInLogOrder) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto messages = random_messages(seed, 300);
    const Bytes file = file_of(messages, small_chunks(GetParam()));
    const auto reader = Reader::open(memory_source(file));
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_EQ(reader->damage(), "");
    EXPECT_EQ(reader->header().profile, "ros2");
    EXPECT_EQ(read_all(*reader), in_log_order(messages));
    EXPECT_EQ(reader->summary().statistics->message_count, messages.size());
    EXPECT_GT(reader->summary().chunks.size(), 10U);
    const auto report = verify(*memory_source(file));
    ASSERT_TRUE(report.ok());
    EXPECT_TRUE(report->closed);
    EXPECT_EQ(report->messages, messages.size());
    EXPECT_EQ(report->faults, std::vector<std::string>{});
  }
}

TEST_P(RoundTrip, TimeRangesAndTopicsAreTheOnesAsked) {
  const auto messages = in_log_order(random_messages(3, 400));
  const Bytes file = file_of(random_messages(3, 400), small_chunks(GetParam()));
  const auto reader = Reader::open(memory_source(file));
  ASSERT_TRUE(reader.ok());
  Random random(1, "ranges");
  for (int i = 0; i < 50; ++i) {
    ReadOptions options;
    options.begin = at_ns(random.integer(0, 45'000));
    options.end = at_ns(random.integer(0, 45'000));
    const std::string topic = "/topic_" + std::to_string(random.integer(0, 5));
    options.accept = [&topic](const Channel& channel) { return channel.topic == topic; };
    std::vector<TestMessage> expected;
    for (const TestMessage& message : messages) {
      if (message.topic == topic && message.log_time >= options.begin &&
          message.log_time < options.end) {
        expected.push_back(message);
      }
    }
    EXPECT_EQ(read_all(*reader, options), expected);
  }
}

TEST(Mcap, AFileWithoutMessagesIsSound) {
  const Bytes file = file_of({}, {});
  const auto reader = Reader::open(memory_source(file));
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(read_all(*reader).empty());
  EXPECT_TRUE(verify(*memory_source(file))->faults.empty());
}

TEST(Mcap, MessagesOfAnySizeComeBack) {
  std::vector<TestMessage> messages;
  for (const std::size_t size : {0U, 1U, 4095U, 4096U, 4097U, 300'000U}) {
    messages.push_back({"/a", 0, at_ns(static_cast<std::int64_t>(size)), {}, Bytes(size)});
  }
  for (const auto compression : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    const Bytes file = file_of(messages, small_chunks(compression));
    EXPECT_EQ(read_all(*Reader::open(memory_source(file))), messages);
  }
}

TEST(Mcap, AttachmentsAndMetadataComeBack) {
  Bytes file;
  auto writer = std::move(Writer::open(memory_sink(file)).value());
  const Attachment attachment{at_ns(5), at_ns(4), "field.json", "text/json", bytes_of("{}")};
  const Metadata metadata{"furrow", {{"seed", "7"}, {"empty", ""}}};
  ASSERT_TRUE(writer->write(attachment).ok());
  ASSERT_TRUE(writer->write(metadata).ok());
  ASSERT_TRUE(writer->close().ok());
  const auto reader = Reader::open(memory_source(file));
  ASSERT_TRUE(reader.ok());
  ASSERT_EQ(reader->summary().attachments.size(), 1U);
  ASSERT_EQ(reader->summary().metadata.size(), 1U);
  const auto a = reader->attachment(reader->summary().attachments.front());
  ASSERT_TRUE(a.ok());
  EXPECT_EQ(a->name, attachment.name);
  EXPECT_EQ(a->media_type, attachment.media_type);
  EXPECT_EQ(a->data, attachment.data);
  EXPECT_EQ(a->create_time, attachment.create_time);
  const auto m = reader->metadata(reader->summary().metadata.front());
  ASSERT_TRUE(m.ok());
  EXPECT_EQ(m->values, metadata.values);
  EXPECT_TRUE(verify(*memory_source(file))->faults.empty());
}

TEST(Mcap, ChannelsAndSchemasComeBackAndAreSharedByContent) {
  Bytes file;
  auto writer = std::move(Writer::open(memory_sink(file)).value());
  const auto a = writer->add_schema("pkg/msg/A", "ros2msg", "int32 x");
  const auto again = writer->add_schema("pkg/msg/A", "ros2msg", "int32 x");
  const auto b = writer->add_schema("pkg/msg/A", "ros2msg", "int32 y");
  ASSERT_TRUE(a.ok() && again.ok() && b.ok());
  EXPECT_EQ(*a, *again);
  EXPECT_NE(*a, *b);
  const auto channel = writer->add_channel({99, *a, "/x", "cdr", {{"qos", "reliable"}}});
  ASSERT_TRUE(channel.ok());
  ASSERT_TRUE(writer->close().ok());
  const auto reader = Reader::open(memory_source(file));
  ASSERT_TRUE(reader.ok());
  const Channel* read = reader->channel(*channel);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(read->topic, "/x");
  EXPECT_EQ(read->metadata, (StringMap{{"qos", "reliable"}}));
  EXPECT_EQ(reader->summary().schemas.at(*a).data, "int32 x");
  EXPECT_EQ(reader->channel(1234), nullptr);
}

}  // namespace
}  // namespace furrow::mcap
