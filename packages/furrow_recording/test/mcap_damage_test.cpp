#include <gtest/gtest.h>

#include <limits>

#include "mcap_test_support.hpp"

namespace furrow::mcap {
namespace {

/// A small file with everything in it.
Bytes small_file(Compression compression, const std::vector<TestMessage>& messages) {
  Bytes file;
  TestWriter writer(memory_sink(file), small_chunks(compression, 256));
  EXPECT_TRUE(writer.get().write(Metadata{"run", {{"seed", "1"}}}).ok());
  for (const TestMessage& message : messages) {
    EXPECT_TRUE(writer.write(message).ok());
  }
  EXPECT_TRUE(writer.get().write(Attachment{at_ns(1), {}, "a", "b", bytes_of("c")}).ok());
  EXPECT_TRUE(writer.get().close().ok());
  return file;
}

TEST(McapDamage, EveryTruncationGivesAnErrorOrAPrefix) {
  const auto messages = random_messages(5, 15, 3, 100);
  for (const auto compression : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    const Bytes whole = small_file(compression, messages);
    std::size_t before = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto file = std::span(whole).first(size);
      const auto reader = Reader::open(memory_source(file));
      if (!reader) {
        EXPECT_EQ(reader.error().code, ErrorCode::kParse);
        EXPECT_FALSE(reader.error().message.empty());
        EXPECT_EQ(before, 0U) << "readable when shorter, but not at " << size;
        continue;
      }
      EXPECT_NE(reader->damage(), "");
      std::vector<TestMessage> expected = messages;
      const auto read = read_all(*reader);
      ASSERT_LE(read.size(), messages.size());
      ASSERT_GE(read.size(), before) << "a longer file gives less, at " << size;
      expected.resize(read.size());
      ASSERT_EQ(read, in_log_order(expected)) << size;
      before = read.size();

      const auto report = verify(*memory_source(file));
      ASSERT_TRUE(report.ok());
      EXPECT_FALSE(report->closed);
      EXPECT_FALSE(report->faults.empty());
      if (size % 7 == 0) {
        Bytes repaired;
        const auto recovered = recover(file, repaired);
        ASSERT_TRUE(recovered.ok());
        EXPECT_EQ(recovered->messages, read.size());
        EXPECT_EQ(read_all(*Reader::open(memory_source(repaired))), read);
        EXPECT_TRUE(verify(*memory_source(repaired))->faults.empty());
      }
    }
    EXPECT_EQ(before, messages.size());
  }
}

TEST(McapDamage, EveryFlippedByteIsFound) {
  const auto messages = random_messages(6, 12, 2, 60);
  const auto ordered = in_log_order(messages);
  for (const auto compression : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    Bytes file = small_file(compression, messages);
    Random random(1, "flips");
    for (std::size_t at = 0; at < file.size(); ++at) {
      const auto bit = static_cast<std::byte>(1U << random.integer(0, 7));
      file[at] ^= bit;
      const auto report = verify(*memory_source(file));
      ASSERT_TRUE(report.ok());
      EXPECT_FALSE(report->faults.empty()) << "flipped at " << at;
      // A reader gives right messages or errors, never wrong messages.
      if (const auto reader = Reader::open(memory_source(file)); reader.ok()) {
        int errors = 0;
        for (const TestMessage& message : read_all(*reader, {}, &errors)) {
          const bool topic_is_damaged = !message.topic.starts_with("/topic_");
          EXPECT_TRUE(topic_is_damaged ||
                      std::find(ordered.begin(), ordered.end(), message) != ordered.end())
              << "flipped at " << at;
        }
      }
      file[at] ^= bit;
    }
    EXPECT_TRUE(verify(*memory_source(file))->faults.empty());
  }
}

TEST(McapDamage, ADamagedChunkCostsOnlyItsMessages) {
  const auto messages = random_messages(7, 40, 3, 100);
  Bytes file = small_file(Compression::kZstd, messages);
  const auto chunks = Reader::open(memory_source(file))->summary().chunks;
  ASSERT_GT(chunks.size(), 4U);
  const ChunkIndex& damaged = chunks[2];
  file[static_cast<std::size_t>(damaged.offset + damaged.length - 5)] ^= std::byte{0xFF};
  ReadOptions of_chunk;
  int errors = 0;
  const auto reader = Reader::open(memory_source(file));
  ASSERT_TRUE(reader.ok());
  const auto read = read_all(*reader, {}, &errors);
  EXPECT_EQ(errors, 1);
  EXPECT_LT(read.size(), messages.size());
  EXPECT_GT(read.size(), messages.size() / 2);
  Bytes repaired;
  const auto report = recover(file, repaired);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->messages, read.size());
  EXPECT_FALSE(report->faults.empty());
  EXPECT_EQ(read_all(*Reader::open(memory_source(repaired))), read);
}

TEST(McapDamage, RandomBytesNeverCrash) {
  Random random(1, "noise");
  const Bytes head = [] {
    Bytes file = small_file(Compression::kZstd, random_messages(8, 5, 2, 40));
    file.resize(60);
    return file;
  }();
  for (int i = 0; i < 2000; ++i) {
    Bytes file(static_cast<std::size_t>(random.integer(0, 400)));
    for (auto& byte : file) {
      byte = random.bernoulli(0.6) ? std::byte{0} : static_cast<std::byte>(random.next());
    }
    if (i % 2 == 0) {
      std::copy_n(head.begin(), std::min(head.size(), file.size()), file.begin());
    }
    int errors = 0;
    if (const auto reader = Reader::open(memory_source(file)); reader.ok()) {
      (void)read_all(*reader, {}, &errors);
    }
    EXPECT_FALSE(verify(*memory_source(file))->faults.empty());
  }
}

TEST(McapDamage, RandomChangesOfAWholeFileNeverCrash) {
  const Bytes whole = small_file(Compression::kLz4, random_messages(9, 20, 3, 80));
  Random random(2, "changes");
  for (int i = 0; i < 2000; ++i) {
    Bytes file = whole;
    for (auto changes = random.integer(1, 6); changes > 0; --changes) {
      const auto at =
          static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(file.size()) - 1));
      file[at] = random.bernoulli(0.5) ? std::byte{0xFF} : static_cast<std::byte>(random.next());
    }
    int errors = 0;
    if (const auto reader = Reader::open(memory_source(file)); reader.ok()) {
      (void)read_all(*reader, {}, &errors);
    }
    if (const auto reader = Reader::scan(memory_source(file)); reader.ok()) {
      (void)read_all(*reader, {}, &errors);
    }
    (void)verify(*memory_source(file));
  }
}

TEST(McapDamage, LengthsFromTheFileTakeNoMemory) {
  // A chunk that announces the largest size that is allowed, of two bytes of content.
  for (const auto compression : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    Bytes file = file_of({{"/a", 0, at_ns(1), {}, bytes_of("x")}}, small_chunks(compression));
    const auto chunk = Reader::open(memory_source(file))->summary().chunks.front();
    const auto size_at = static_cast<std::size_t>(chunk.offset) + 9 + 16;
    ReaderLimits limits;
    for (const std::uint64_t size :
         {limits.record_bytes, std::numeric_limits<std::uint64_t>::max()}) {
      for (std::size_t i = 0; i < 8; ++i) {
        file[size_at + i] = static_cast<std::byte>(size >> (8 * i));
      }
      int errors = 0;
      EXPECT_TRUE(read_all(*Reader::open(memory_source(file)), {}, &errors).empty());
      EXPECT_EQ(errors, 1);
    }
  }
}

TEST(McapDamage, ChunksThatOverlapBeyondTheLimitAreReadAgain) {
  std::vector<TestMessage> messages;
  for (int i = 0; i < 20; ++i) {
    // Every chunk spans the whole time.
    messages.push_back({"/a", 0, at_ns(i), {}, Bytes(3000, static_cast<std::byte>(i))});
    messages.push_back({"/a", 0, at_ns(1000 + i), {}, Bytes(1000, static_cast<std::byte>(i))});
  }
  const Bytes file = file_of(messages, small_chunks(Compression::kNone, 4050));
  ReaderLimits limits;
  limits.open_bytes = 20'000;
  EXPECT_EQ(read_all(*Reader::open(memory_source(file), limits)), in_log_order(messages));
}

TEST(McapDamage, RecordsAboveTheLimitAreNotRead) {
  const Bytes file =
      file_of({{"/a", 0, at_ns(1), {}, Bytes(3000)}}, small_chunks(Compression::kNone));
  ReaderLimits limits;
  limits.record_bytes = 1000;
  const auto reader = Reader::open(memory_source(file), limits);
  ASSERT_TRUE(reader.ok());
  EXPECT_NE(reader->damage(), "");
  EXPECT_TRUE(read_all(*reader).empty());
}

}  // namespace
}  // namespace furrow::mcap
