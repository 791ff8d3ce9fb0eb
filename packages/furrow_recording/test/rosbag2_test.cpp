#include <gtest/gtest.h>

#include <fstream>

#include "db3_recording.hpp"
#include "furrow_core/random.hpp"
#include "furrow_recording/recording_copy.hpp"
#include "furrow_recording/recording_summary.hpp"
#include "recording_test_support.hpp"
#include "rosbag2_metadata.hpp"
#include "test_db3.hpp"

namespace furrow::recording {
namespace {

std::string bytes_in(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Lines string_lines(const RecordingReader& reader) {
  Lines lines;
  const auto stream = reader.messages({});
  while (true) {
    const auto next = stream->next();
    EXPECT_TRUE(next.ok()) << next.error().message;
    if (!next || !*next) return lines;
    const mcap::Message& message = **next;
    EXPECT_GT(message.data.size(), 9U);
    lines.push_back(reader.info().summary.channels.at(message.channel_id).topic + "@" +
                    std::to_string(message.log_time.count_ns() / 1'000'000) + "=" +
                    std::string(reinterpret_cast<const char*>(message.data.data()) + 8,
                                message.data.size() - 9));
  }
}

class Rosbag2 : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
  }
  void write_metadata(const Lines& files, const std::string& mode = "") const {
    std::string yaml =
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
        "  duration:\n    nanoseconds: 1\n  message_count: 999\n"
        "  compression_format: \"" +
        std::string(mode.empty() ? "" : "zstd") + "\"\n  compression_mode: \"" + mode +
        "\"\n  relative_file_paths:\n";
    for (const std::string& file : files) yaml += "    - " + file + "\n";
    write("metadata.yaml", yaml);
  }

  Folder folder_;
};

const Lines kThreeMessages = {"/a@10=one", "/b@20=two", "/a@30=three"};

void add_three_messages(TestDb3& file) {
  file.topic(1, "/a", "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n");
  file.topic(7, "/b");
  file.message(1, 30, "three");
  file.message(1, 10, "one");
  file.message(7, 20, "two");
}

TEST_F(Rosbag2, AFileIsReadInTheOrderOfTime) {
  int number = 0;
  for (const bool indexed : {true, false}) {
    for (const bool packed : {true, false}) {
      const auto file = path("a_" + std::to_string(number++) + ".db3");
      {
        TestDb3 database(file, {.indexed = indexed, .message_compression = packed});
        add_three_messages(database);
      }
      const auto reader = open_recording(file);
      ASSERT_TRUE(reader.ok()) << reader.error().message;
      EXPECT_EQ(string_lines(**reader), kThreeMessages);
      const RecordingInfo& info = (*reader)->info();
      EXPECT_TRUE(info.whole());
      EXPECT_EQ(info.format, "rosbag2");
      EXPECT_EQ(info.statistics().message_count, 3U);
      EXPECT_EQ(info.statistics().end_time, at_ms(30));
      EXPECT_EQ(info.compressions, std::set<std::string>{packed ? "zstd" : "none"});
      const auto topics = summarize_topics(info);
      EXPECT_EQ(topics.at(0).quality, "reliable, latched");
      EXPECT_EQ(topics.at(0).schema, "ros2msg");
      EXPECT_EQ(topics.at(0).messages, 2U);
      EXPECT_EQ(verify_recording(file)->faults, Lines());
    }
  }
}

TEST_F(Rosbag2, FilesOfOldVersionsAreRead) {
  {
    TestDb3 file(path("old.db3"), {.definitions = false, .old_columns = true});
    add_three_messages(file);
  }
  const auto reader = open_recording(path("old.db3"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ(string_lines(**reader), kThreeMessages);
  // Furrow knows this type itself.
  EXPECT_EQ((*reader)->info().summary.schemas.begin()->second.encoding, "ros2msg");
}

TEST_F(Rosbag2, AFolderIsReadByItsMetadata) {
  {
    TestDb3 first(path("run_0.db3"));
    first.topic(1, "/a");
    first.message(1, 10, "one");
    TestDb3 second(path("run_1.db3"));
    second.topic(1, "/b");
    second.topic(2, "/a");
    second.message(1, 20, "two");
    second.message(2, 30, "three");
    TestDb3 other(path("other.db3"));
  }
  write_metadata({"run_0.db3", "run_1.db3"});
  const auto reader = open_recording(folder_.path());
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ(string_lines(**reader), kThreeMessages);
  EXPECT_TRUE((*reader)->info().whole());
  EXPECT_EQ((*reader)->info().statistics().message_count, 3U) << "not as metadata.yaml says";
  EXPECT_EQ((*reader)->info().notes.size(), 1U) << "other.db3 is not listed";
  EXPECT_EQ((*reader)->info().summary.channels.size(), 2U);
}

TEST_F(Rosbag2, FilesThatAreCompressedAsAWholeAreUnpacked) {
  {
    TestDb3 file(path("run_0.db3"));
    add_three_messages(file);
  }
  write("run_0.db3.zstd", zstd_of(bytes_in(path("run_0.db3"))));
  std::filesystem::remove(path("run_0.db3"));
  for (const char* listed : {"run_0.db3.zstd", "run_0.db3"}) {
    write_metadata({listed}, "FILE");
    const auto reader = open_recording(folder_.path());
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_EQ(string_lines(**reader), kThreeMessages);
  }
  const std::string packed = bytes_in(path("run_0.db3.zstd"));
  write("run_0.db3.zstd", packed.substr(0, packed.size() / 2));
  const auto reader = open_recording(folder_.path());
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code, ErrorCode::kParse);
}

TEST_F(Rosbag2, AFolderWithoutMetadataIsDamagedAndRead) {
  {
    TestDb3 file(path("run_0.db3"));
    add_three_messages(file);
  }
  const auto reader = open_recording(folder_.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(string_lines(**reader), kThreeMessages);
  EXPECT_NE((*reader)->info().damage, "");
  write_metadata({"run_0.db3", "run_1.db3"});
  const auto partial = open_recording(folder_.path());
  ASSERT_TRUE(partial.ok());
  EXPECT_EQ((*partial)->info().faults.size(), 1U) << "run_1.db3 is missing";
}

TEST_F(Rosbag2, AFolderOfMcapFilesIsRead) {
  {
    auto writer = std::move(
        mcap::Writer::open(std::move(mcap::create_file(path("run_0.mcap")).value())).value());
    ASSERT_TRUE(writer->write(mcap::Metadata{"rosbag2", {{"a", "b"}}}).ok());
    ASSERT_TRUE(writer->close().ok());
  }
  write_metadata({"run_0.mcap"});
  const auto reader = open_recording(folder_.path());
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  ASSERT_EQ((*reader)->info().summary.metadata.size(), 1U);
  EXPECT_EQ((*reader)->metadata(0)->values.at("a"), "b");
}

TEST_F(Rosbag2, WhatIsNotARecordingIsRefused) {
  {
    TestDb3 file(path("empty.db3"));
    file.run("DROP TABLE messages");
    TestDb3 view(path("view.db3"));
    view.run("DROP TABLE messages");
    view.run(
        "CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x FROM n) "
        "SELECT x AS id, x AS topic_id, x AS timestamp, x AS data FROM n");
  }
  EXPECT_EQ(open_recording(path("empty.db3")).error().code, ErrorCode::kParse);
  EXPECT_EQ(open_recording(path("view.db3")).error().code, ErrorCode::kParse);
  EXPECT_EQ(open_recording(path("missing.db3")).error().code, ErrorCode::kNotFound);
  std::filesystem::create_directory(path("nothing"));
  EXPECT_EQ(open_recording(path("nothing")).error().code, ErrorCode::kParse);
  for (const char* yaml : {"", "a: [", "rosbag2_bagfile_information: 3",
                           "rosbag2_bagfile_information:\n  relative_file_paths: [../secret.db3]",
                           "rosbag2_bagfile_information:\n  relative_file_paths: [/etc/passwd]",
                           "rosbag2_bagfile_information:\n  compression_format: rar\n"
                           "  relative_file_paths: [a.db3]"}) {
    EXPECT_FALSE(parse_rosbag2_metadata(yaml).ok()) << yaml;
  }
}

TEST_F(Rosbag2, ConversionKeepsEveryMessage) {
  {
    TestDb3 file(path("run_0.db3"), {.message_compression = true});
    add_three_messages(file);
    file.topic(9, "/strange", "", "protobuf");
    file.message(9, 40, "four");
  }
  CopyJob job;
  job.inputs = {path("run_0.db3")};
  job.output = path("run.mcap");
  const auto report = run_copy(job);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_EQ(report->messages, 4U);
  const auto reader = std::move(open_recording(job.output).value());
  Lines expected = kThreeMessages;
  expected.push_back("/strange@40=four");
  EXPECT_EQ(string_lines(*reader), expected);
  EXPECT_EQ(reader->info().summary.channels.at(2).message_encoding, "protobuf");
  EXPECT_EQ(verify_recording(job.output)->faults, Lines());
}

TEST_F(Rosbag2, RandomChangesNeverCrash) {
  {
    TestDb3 file(path("run_0.db3"));
    add_three_messages(file);
  }
  const std::string whole = bytes_in(path("run_0.db3"));
  Random random(4, "db3");
  for (int i = 0; i < 300; ++i) {
    std::string file = whole;
    for (auto changes = random.integer(1, 20); changes > 0; --changes) {
      file[static_cast<std::size_t>(random.integer(
          16, static_cast<std::int64_t>(file.size()) - 1))] = static_cast<char>(random.next());
    }
    const auto view = std::as_bytes(std::span(file));
    OpenOptions options;
    options.scan = i % 2 == 0;
    const auto reader = open_db3(std::vector<std::byte>(view.begin(), view.end()), options);
    if (!reader) continue;
    const auto stream = (*reader)->messages({});
    int errors = 0;
    for (auto next = stream->next(); (!next || *next) && errors < 100; next = stream->next()) {
      errors += next ? 0 : 1;
    }
    EXPECT_LT(errors, 100);
  }
}

}  // namespace
}  // namespace furrow::recording
