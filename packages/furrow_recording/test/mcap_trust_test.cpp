// A file's statistics, indexes and repeated definitions are optional, and may be wrong. So may the
// times of a chunk.
#include <gtest/gtest.h>

#include <limits>

#include "raw_mcap_file.hpp"

namespace furrow::mcap {
namespace {

constexpr std::uint64_t kNoTime = std::numeric_limits<std::uint64_t>::max();

/// A file as the MCAP library behind rosbag2 writes it when the first message is larger than a
/// chunk. The definitions have a chunk of their own: without messages, hence without times.
RawMcapFile camera_file(int images) {
  RawMcapFile file;
  Bytes definitions;
  file.define(&definitions);
  file.add_chunk(definitions, kNoTime, 0);
  for (int i = 0; i < images; ++i) {
    file.add_message_chunk(1000 + 100 * i);
  }
  return file;
}

std::vector<std::int64_t> times_of(const std::vector<TestMessage>& messages) {
  std::vector<std::int64_t> times;
  for (const TestMessage& message : messages) {
    times.push_back(message.log_time.count_ns());
  }
  return times;
}

TEST(McapTrust, AChunkWithoutMessagesMayHaveAnyTimes) {
  RawMcapFile file = camera_file(5);
  file.summary.chunks.front().start_time = at_ns(0);
  file.summary.chunks.front().end_time = at_ns(0);
  const Bytes whole = file.closed();
  const auto report = verify(*memory_source(whole));
  EXPECT_EQ(report->faults, std::vector<std::string>());
  EXPECT_TRUE(report->closed);
  EXPECT_EQ(report->messages, 5U);
  const auto reader = Reader::open(memory_source(whole));
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader->damage(), "");
  EXPECT_EQ(times_of(read_all(*reader)), (std::vector<std::int64_t>{1000, 1100, 1200, 1300, 1400}));
}

TEST(McapTrust, AKilledRecordersFileWithSuchAChunkIsRecovered) {
  const RawMcapFile file = camera_file(5);
  Bytes repaired;
  const auto report = recover(file.bytes, repaired);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->messages, 5U);
  EXPECT_EQ(report->faults, std::vector<std::string>());
  EXPECT_NE(report->damage, "");
  EXPECT_EQ(verify(*memory_source(repaired))->messages, 5U);
}

TEST(McapTrust, ARangeIsByTheMessagesTimesNotByTheChunks) {
  RawMcapFile file;
  file.define();
  for (const std::int64_t time : {10, 20, 30, 40}) {
    Bytes records;
    RawMcapFile::add_message(records, time, "x");
    file.add_chunk(records, 0, 0, {{1, {{at_ns(time), 0}}}});
  }
  const Bytes whole = file.closed();
  const auto reader = Reader::open(memory_source(whole));
  ASSERT_TRUE(reader.ok());
  ReadOptions range;
  range.begin = at_ns(20);
  range.end = at_ns(40);
  EXPECT_EQ(times_of(read_all(*reader, range)), (std::vector<std::int64_t>{20, 30}));
  EXPECT_EQ(reader->summary().statistics->start_time, at_ns(10));
  EXPECT_EQ(reader->summary().statistics->end_time, at_ns(40));
  EXPECT_FALSE(verify(*memory_source(whole))->faults.empty()) << "the times are wrong";
}

TEST(McapTrust, MessageIndexesWithWrongTimesAreNotUsed) {
  RawMcapFile file;
  file.define();
  Bytes records;
  RawMcapFile::add_message(records, 50, "x");
  file.add_chunk(records, 50, 50, {{1, {{at_ns(7), 0}}}});
  file.add_message_chunk(20);
  const auto reader = Reader::open(memory_source(file.closed()));
  EXPECT_EQ(times_of(read_all(*reader)), (std::vector<std::int64_t>{20, 50}));
}

TEST(McapTrust, TopicsThatOnlyTheSummaryDefinesAreSoundAndListed) {
  RawMcapFile file;
  file.define();
  file.add_message_chunk(5);
  file.summary.channels[2] = {2, 1, "/silent", "cdr", {}};
  Statistics statistics;
  statistics.message_count = 1;
  statistics.schema_count = 1;
  statistics.channel_count = 1;  // those of the data section
  statistics.chunk_count = 1;
  statistics.start_time = statistics.end_time = at_ns(5);
  statistics.channel_message_counts = {{1, 1}, {2, 0}};
  file.summary.statistics = statistics;
  const Bytes whole = file.closed();
  EXPECT_EQ(verify(*memory_source(whole))->faults, std::vector<std::string>());
  const auto reader = Reader::open(memory_source(whole));
  ASSERT_NE(reader->channel(2), nullptr);
  EXPECT_EQ(reader->channel(2)->topic, "/silent");
}

TEST(McapTrust, CountsComeFromTheMessages) {
  RawMcapFile file;
  file.define();
  file.add_message_chunk(5);
  file.add_message_chunk(6);
  file.summary.statistics = Statistics();  // zero messages
  const Bytes whole = file.closed();
  const auto reader = Reader::open(memory_source(whole));
  EXPECT_EQ(reader->summary().statistics->message_count, 2U);
  EXPECT_EQ(read_all(*reader).size(), 2U);
  EXPECT_FALSE(reader->faults().empty());
}

TEST(McapTrust, AChunkThatIsNotIndexedIsRead) {
  RawMcapFile file;
  file.define();
  file.add_message_chunk(5);
  file.add_message_chunk(6);
  file.summary.chunks.pop_back();
  const Bytes whole = file.closed();
  EXPECT_EQ(read_all(*Reader::open(memory_source(whole))).size(), 2U);
  EXPECT_FALSE(verify(*memory_source(whole))->faults.empty());
}

TEST(McapTrust, ChannelsOfChunksAreFoundWithoutTheirRepetition) {
  RawMcapFile file = camera_file(2);
  file.summary.channels.clear();
  const auto without_channels = Reader::open(memory_source(file.closed()));
  EXPECT_EQ(read_all(*without_channels).size(), 2U);
  file = camera_file(2);
  file.summary.schemas.clear();
  const auto without_schemas = Reader::open(memory_source(file.closed()));
  EXPECT_EQ(without_schemas->summary().schemas.at(1).name, "std_msgs/msg/String");
  file.summary = {};
  const auto without_summary = Reader::open(memory_source(file.closed()));
  EXPECT_EQ(read_all(*without_summary).size(), 2U);
  EXPECT_EQ(without_summary->damage(), "") << "a summary is optional";
}

TEST(McapTrust, AttachmentsAndMetadataAreFoundWithoutIndexesAndBehindWrongOnes) {
  RawMcapFile file;
  file.define();
  const std::uint64_t attachment_at = file.bytes.size();
  ByteWriter out(file.bytes);
  put(out, Attachment{at_ns(1), at_ns(1), "calibration", "text/yaml", bytes_of("fx: 600")});
  put(out, Metadata{"robot", {{"name", "r1"}}});
  file.add_message_chunk(5);
  for (const bool indexed : {false, true}) {
    if (indexed) {
      file.summary.attachments.push_back({attachment_at + 3, 9, {}, {}, 7, "calibration", ""});
    }
    Bytes copied;
    const auto report = copy(file.closed(), copied);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report->attachments, 1U);
    EXPECT_EQ(report->metadata, 1U);
    EXPECT_EQ(report->messages, 1U);
    const auto reader = Reader::open(memory_source(copied));
    EXPECT_EQ(reader->attachment(reader->summary().attachments.at(0))->data, bytes_of("fx: 600"));
    EXPECT_EQ(reader->metadata(reader->summary().metadata.at(0))->values.at("name"), "r1");
  }
}

TEST(McapTrust, AWrongRecordLengthCostsOnlyThatRecord) {
  RawMcapFile file = camera_file(6);
  Bytes whole = file.closed();
  const std::size_t length_at = static_cast<std::size_t>(file.summary.chunks.at(3).offset) + 1;
  for (const int length : {0xFF, 0x00}) {
    Bytes damaged = whole;
    damaged[length_at + 1] = static_cast<std::byte>(length);  // 256 bytes a step
    const auto reader = Reader::open(memory_source(damaged));
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(times_of(read_all(*reader)),
              (std::vector<std::int64_t>{1000, 1100, 1300, 1400, 1500}))
        << length;
    EXPECT_FALSE(reader->faults().empty());
  }
}

}  // namespace
}  // namespace furrow::mcap
