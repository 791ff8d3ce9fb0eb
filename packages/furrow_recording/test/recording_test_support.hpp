#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_verify.hpp"
#include "furrow_recording/mcap_writer.hpp"
#include "furrow_recording/recorder.hpp"
#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

using Bytes = std::vector<std::byte>;

inline Time at_ms(std::int64_t ms) {
  return Time() + Duration::milliseconds(ms);
}
inline Payload payload_of(std::size_t bytes, int value = 0) {
  return std::make_shared<const Bytes>(bytes, static_cast<std::byte>(value));
}
inline std::unique_ptr<RecordingReader> reader_of(std::span<const std::byte> file) {
  auto reader = open_recording(mcap::memory_source(file));
  EXPECT_TRUE(reader.ok()) << (reader ? "" : reader.error().message);
  return std::move(reader.value());
}
inline TopicDescription topic_of(const std::string& name, bool latched = false) {
  TopicDescription topic;
  topic.name = name;
  topic.type_name = "pkg/msg/Type";
  topic.offered_qos = {latched ? msgs::latched_qos() : msgs::event_qos()};
  return topic;
}

/// A disk in memory, with a free space that tests set.
struct TestDisk {
  std::map<std::string, Bytes> files;
  std::uint64_t free = 1'000'000'000'000;

  RecorderEnvironment environment() {
    RecorderEnvironment environment;
    environment.create_file =
        [this](const std::filesystem::path& path) -> Result<std::unique_ptr<mcap::Sink>> {
      return mcap::memory_sink(files[path.filename().string()]);
    };
    environment.free_bytes = [this](const std::filesystem::path&) -> Result<std::uint64_t> {
      return free;
    };
    return environment;
  }
};

/// The messages as "topic@ms=first byte", in log order.
inline std::vector<std::string> content_of(const Bytes& file) {
  const auto reader = mcap::Reader::open(mcap::memory_source(file));
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader->damage(), "");
  std::vector<std::string> content;
  auto cursor = reader->messages();
  while (true) {
    const auto next = cursor.next();
    EXPECT_TRUE(next.ok());
    if (!next || !*next) {
      return content;
    }
    const mcap::Message& message = **next;
    content.push_back(reader->channel(message.channel_id)->topic + "@" +
                      std::to_string(message.log_time.count_ns() / 1'000'000) + "=" +
                      std::to_string(std::to_integer<int>(message.data[0])));
  }
}

using Lines = std::vector<std::string>;

/// A folder that the test makes and removes.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::path(testing::TempDir()) /
              ("furrow_recording_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace furrow::recording
