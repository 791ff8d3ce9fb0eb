#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "mcap_test_support.hpp"

namespace furrow::mcap {
namespace {

/// A disk with so much space; it takes what fits of a write and then refuses.
class SmallDisk final : public Sink {
 public:
  SmallDisk(Bytes& bytes, std::size_t capacity) : bytes_(bytes), capacity_(capacity) {}
  Status write(std::span<const std::byte> bytes) override {
    const std::size_t fits = std::min(bytes.size(), capacity_ - bytes_.size());
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(fits));
    return fits == bytes.size() ? Status() : Error{ErrorCode::kIo, "no space left"};
  }
  Status truncate(std::uint64_t size) override {
    bytes_.resize(static_cast<std::size_t>(size));
    return {};
  }
  Status sync() override { return {}; }

 private:
  Bytes& bytes_;
  std::size_t capacity_;
};

TEST(McapWriter, AFullDiskLeavesAWholeFileOfWhatFitted) {
  const auto messages = random_messages(1, 60, 2, 300);
  const std::size_t full = file_of(messages, small_chunks(Compression::kNone, 1000)).size();
  int closed = 0;
  for (std::size_t capacity = 200; capacity < full; capacity += 97) {
    Bytes file;
    std::uint64_t lost = 0;
    std::uint64_t accepted = 0;
    {
      TestWriter writer(std::make_unique<SmallDisk>(file, capacity),
                        small_chunks(Compression::kNone, 1000));
      Status status;
      for (const TestMessage& message : messages) {
        status = writer.write(message);
        if (!status) {
          EXPECT_EQ(status.error().code, ErrorCode::kIo);
          EXPECT_EQ(writer.write(message).error().message, status.error().message);
          break;
        }
        ++accepted;
      }
      const Status end = writer.get().close();
      EXPECT_FALSE(status && end) << capacity;
      EXPECT_TRUE(writer.get().close().ok()) << "a second close does nothing";
      lost = writer.get().lost_messages();
    }
    const auto reader = Reader::open(memory_source(file));
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    const auto read = read_all(*reader);
    auto expected = messages;
    expected.resize(read.size());
    EXPECT_EQ(read, in_log_order(expected));
    EXPECT_GE(read.size() + lost, accepted);
    closed += reader->damage().empty() ? 1 : 0;
  }
  // Where the summary is smaller than the chunk that did not fit, the file is whole.
  EXPECT_GT(closed, 0);
}

TEST(McapWriter, WhatIsFlushedIsReadableWithoutClose) {
  const auto messages = random_messages(2, 100);
  Bytes file;
  TestWriter writer(memory_sink(file), small_chunks(Compression::kZstd));
  for (const TestMessage& message : messages) {
    ASSERT_TRUE(writer.write(message).ok());
  }
  ASSERT_TRUE(writer.get().flush().ok());
  EXPECT_EQ(writer.get().bytes_pending(), 0U);
  EXPECT_EQ(writer.get().bytes_written(), file.size());
  const Bytes killed = file;
  const auto reader = Reader::open(memory_source(killed));
  ASSERT_TRUE(reader.ok());
  EXPECT_NE(reader->damage(), "");
  EXPECT_EQ(reader->bytes_ignored(), 0U);
  EXPECT_EQ(read_all(*reader), in_log_order(messages));
}

TEST(McapWriter, RefusesWhatIsWrong) {
  Bytes file;
  WriterOptions options;
  options.max_message_bytes = 10;
  auto writer = std::move(Writer::open(memory_sink(file), options).value());
  EXPECT_EQ(writer->write(Message{}).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(writer->add_channel({0, 3, "/a", "cdr", {}}).error().code, ErrorCode::kInvalidArgument);
  const auto channel = writer->add_channel({0, 0, "/a", "cdr", {}});
  ASSERT_TRUE(channel.ok());
  Message message;
  message.channel_id = *channel;
  message.log_time = at_ns(-1);
  EXPECT_EQ(writer->write(message).error().code, ErrorCode::kInvalidArgument);
  message.log_time = at_ns(1);
  const Bytes large(11);
  message.data = large;
  EXPECT_EQ(writer->write(message).error().code, ErrorCode::kOutOfRange);
  ASSERT_TRUE(writer->close().ok());
  message.data = {};
  EXPECT_EQ(writer->write(message).error().code, ErrorCode::kInvalidArgument);
  EXPECT_TRUE(verify(*memory_source(file))->faults.empty());
}

TEST(McapWriter, StatisticsCountWhatWaitsInMemory) {
  Bytes file;
  TestWriter writer(memory_sink(file), {});
  ASSERT_TRUE(writer.write({"/a", 0, at_ns(7), {}, bytes_of("x")}).ok());
  const Statistics statistics = writer.get().statistics();
  EXPECT_EQ(statistics.message_count, 1U);
  EXPECT_EQ(statistics.start_time, at_ns(7));
  EXPECT_EQ(statistics.channel_message_counts.size(), 1U);
}

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("furrow_mcap_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(Files, AFileOnDiskIsTheFileInMemory) {
  const auto messages = random_messages(4, 50);
  {
    TestWriter writer(std::move(create_file(folder_ / "a.mcap").value()), {});
    for (const TestMessage& message : messages) {
      ASSERT_TRUE(writer.write(message).ok());
    }
    ASSERT_TRUE(writer.get().close().ok());
  }
  auto source = open_file(folder_ / "a.mcap");
  ASSERT_TRUE(source.ok());
  Bytes bytes(static_cast<std::size_t>((*source)->size()));
  ASSERT_TRUE((*source)->read(0, bytes).ok());
  EXPECT_EQ(bytes, file_of(messages, {}));
  std::byte beyond{};
  EXPECT_EQ((*source)->read(bytes.size(), {&beyond, 1}).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(read_all(*Reader::open(std::move(*source))), in_log_order(messages));
}

TEST_F(Files, ExistingFilesAreKeptAndMissingOnesNamed) {
  std::ofstream(folder_ / "there") << "text";
  EXPECT_EQ(create_file(folder_ / "there").error().code, ErrorCode::kIo);
  EXPECT_EQ(create_file(folder_ / "no" / "folder").error().code, ErrorCode::kIo);
  EXPECT_EQ(open_file(folder_ / "missing").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(open_file(folder_).error().code, ErrorCode::kIo);
  EXPECT_EQ(Reader::open(std::move(open_file(folder_ / "there").value())).error().code,
            ErrorCode::kParse);
}

}  // namespace
}  // namespace furrow::mcap
