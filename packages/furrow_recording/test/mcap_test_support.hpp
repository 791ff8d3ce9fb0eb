#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_verify.hpp"
#include "furrow_recording/mcap_writer.hpp"
#include "furrow_recording/recording_copy.hpp"

namespace furrow::mcap {

using Bytes = std::vector<std::byte>;

/// A message that owns its data and names its topic, for comparison.
struct TestMessage {
  std::string topic;
  std::uint32_t sequence = 0;
  Time log_time;
  Time publish_time;
  Bytes data;
  bool operator==(const TestMessage&) const = default;
};

inline Bytes bytes_of(std::string_view text) {
  const auto view = std::as_bytes(std::span(text));
  return {view.begin(), view.end()};
}

/// Random topics, times (not in order), sizes and contents, half of them compressible.
inline std::vector<TestMessage> random_messages(std::uint64_t seed, int count, int topics = 5,
                                                std::int64_t max_bytes = 3000) {
  Random random(seed, "messages");
  std::vector<TestMessage> messages;
  for (int i = 0; i < count; ++i) {
    TestMessage message;
    message.topic = "/topic_" + std::to_string(random.integer(0, topics - 1));
    message.sequence = static_cast<std::uint32_t>(i);
    // Jittered, so that chunks overlap in time, and with equal times.
    message.log_time = Time::from_nanoseconds(i * 100 + random.integer(0, 30) * 100);
    message.publish_time = Time::from_nanoseconds(random.integer(0, 1'000'000));
    message.data.resize(static_cast<std::size_t>(random.integer(0, max_bytes)));
    const bool noise = random.bernoulli(0.5);
    for (auto& byte : message.data) {
      byte = noise ? static_cast<std::byte>(random.next()) : std::byte{7};
    }
    messages.push_back(std::move(message));
  }
  return messages;
}

/// The messages in the order of a reader.
inline std::vector<TestMessage> in_log_order(std::vector<TestMessage> messages) {
  std::stable_sort(
      messages.begin(), messages.end(),
      [](const TestMessage& a, const TestMessage& b) { return a.log_time < b.log_time; });
  return messages;
}

/// Writes messages by topic, and adds channels as topics appear.
class TestWriter {
 public:
  TestWriter(std::unique_ptr<Sink> sink, const WriterOptions& options)
      : writer_(std::move(Writer::open(std::move(sink), options).value())) {}

  Status write(const TestMessage& message) {
    if (!channels_.contains(message.topic)) {
      const auto schema = writer_->add_schema("pkg/msg/Type", "omgidl", "struct Type {};");
      if (!schema) {
        return schema.error();
      }
      const auto channel =
          writer_->add_channel({0, *schema, message.topic, "cdr", {{"key", message.topic}}});
      if (!channel) {
        return channel.error();
      }
      channels_[message.topic] = *channel;
    }
    return writer_->write(Message{channels_[message.topic], message.sequence, message.log_time,
                                  message.publish_time, message.data});
  }
  Writer& get() { return *writer_; }

 private:
  std::unique_ptr<Writer> writer_;
  std::map<std::string, ChannelId> channels_;
};

inline Bytes file_of(const std::vector<TestMessage>& messages, const WriterOptions& options) {
  Bytes file;
  TestWriter writer(memory_sink(file), options);
  for (const TestMessage& message : messages) {
    EXPECT_TRUE(writer.write(message).ok());
  }
  EXPECT_TRUE(writer.get().close().ok());
  return file;
}

/// Reads all messages and counts the errors between them.
inline std::vector<TestMessage> read_all(const Reader& reader, ReadOptions options = {},
                                         int* errors = nullptr) {
  std::vector<TestMessage> messages;
  MessageCursor cursor = reader.messages(std::move(options));
  while (true) {
    const auto next = cursor.next();
    if (!next) {
      if (errors == nullptr) {
        ADD_FAILURE() << next.error().message;
        return messages;
      }
      ++*errors;
      continue;
    }
    if (!*next) {
      return messages;
    }
    const Message& message = **next;
    messages.push_back({reader.channel(message.channel_id)->topic, message.sequence,
                        message.log_time, message.publish_time,
                        Bytes(message.data.begin(), message.data.end())});
  }
}

/// Copies a file in memory, as the tools do with files.
inline Result<recording::CopyReport> copy(std::span<const std::byte> file, Bytes& output,
                                          const recording::Selection& selection = {},
                                          const recording::OpenOptions& open = {}) {
  const auto reader = recording::open_recording(memory_source(file), open);
  if (!reader) {
    return reader.error();
  }
  auto writer = Writer::open(memory_sink(output));
  if (!writer) {
    return writer.error();
  }
  auto report = recording::copy_recording(**reader, **writer, selection);
  if (Status status = (*writer)->close(); !status) {
    return status.error();
  }
  return report;
}

/// As `furrow bag recover`: reads every byte of the input.
inline Result<recording::CopyReport> recover(std::span<const std::byte> file, Bytes& output) {
  recording::OpenOptions open;
  open.scan = true;
  return copy(file, output, {}, open);
}

inline WriterOptions small_chunks(Compression compression, std::size_t chunk_bytes = 4096) {
  WriterOptions options;
  options.compression = compression;
  options.chunk_bytes = chunk_bytes;
  return options;
}

inline Time at_ns(std::int64_t ns) {
  return Time::from_nanoseconds(ns);
}

}  // namespace furrow::mcap
