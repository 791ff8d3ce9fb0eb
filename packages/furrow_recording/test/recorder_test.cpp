#include "furrow_recording/recorder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

TEST(Recorder, RecordsTopicsWithTheirDescription) {
  TestDisk disk;
  Recorder recorder({}, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  const auto map = recorder.add_topic(topic_of("map", true));
  EXPECT_EQ(recorder.add_topic(topic_of("a")), a);
  EXPECT_TRUE(recorder.write(a, at_ms(1), at_ms(0), payload_of(10, 1)).ok());
  EXPECT_TRUE(recorder.write(map, at_ms(2), at_ms(1), payload_of(20, 2)).ok());
  EXPECT_TRUE(recorder.stop().ok());
  const RecorderStatus status = recorder.status();
  EXPECT_EQ(status.state, RecorderState::kStopped);
  EXPECT_EQ(status.messages, 2U);
  EXPECT_EQ(status.dropped, 0U);
  EXPECT_EQ(status.topics.at(map).bytes, 20U);
  ASSERT_EQ(disk.files.size(), 1U);
  const Bytes& file = disk.files.at("run_0.mcap");
  EXPECT_EQ(status.bytes, file.size());
  EXPECT_EQ(content_of(file), (Lines{"/a@1=1", "/map@2=2"}));
  const auto reader = mcap::Reader::open(mcap::memory_source(file));
  const auto& channels = reader->summary().channels;
  EXPECT_TRUE(describe_channel(channels.at(1), nullptr).latched());
  EXPECT_FALSE(describe_channel(channels.at(0), nullptr).latched());
}

TEST(Recorder, SplitsBySize) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.compression = "none";
  parameters.split_mb = 0.1;
  Recorder recorder(parameters, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(recorder.write(a, at_ms(i), at_ms(i), payload_of(10'000, i)).ok());
  }
  ASSERT_TRUE(recorder.stop().ok());
  const auto status = recorder.status();
  EXPECT_EQ(status.files.size(), disk.files.size());
  EXPECT_NEAR(static_cast<double>(disk.files.size()), 10.0, 1.0);
  std::size_t messages = 0;
  for (std::size_t i = 0; i < disk.files.size(); ++i) {
    const Bytes& file = disk.files.at("run_" + std::to_string(i) + ".mcap");
    EXPECT_LT(file.size(), 120'000U);
    messages += content_of(file).size();
  }
  EXPECT_EQ(messages, 100U);
  EXPECT_EQ(status.messages, 100U);
}

TEST(Recorder, SplitsByDuration) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.split_s = 0.01;
  Recorder recorder(parameters, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  for (const int ms : {5, 10, 14, 15, 24, 99}) {
    ASSERT_TRUE(recorder.write(a, at_ms(ms), at_ms(ms), payload_of(1)).ok());
  }
  ASSERT_TRUE(recorder.stop().ok());
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")), (Lines{"/a@5=0", "/a@10=0", "/a@14=0"}));
  EXPECT_EQ(content_of(disk.files.at("run_1.mcap")), (Lines{"/a@15=0", "/a@24=0"}));
  EXPECT_EQ(content_of(disk.files.at("run_2.mcap")), (Lines{"/a@99=0"}));
}

TEST(Recorder, PausesAndKeepsWhatIsLatched) {
  TestDisk disk;
  Recorder recorder({}, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  const auto map = recorder.add_topic(topic_of("map", true));
  (void)recorder.write(a, at_ms(1), {}, payload_of(1, 1));
  recorder.pause();
  EXPECT_EQ(recorder.status().state, RecorderState::kPaused);
  (void)recorder.write(a, at_ms(2), {}, payload_of(1, 2));
  (void)recorder.write(map, at_ms(3), {}, payload_of(1, 3));
  (void)recorder.write(map, at_ms(4), {}, payload_of(1, 4));
  recorder.resume();
  (void)recorder.write(a, at_ms(5), {}, payload_of(1, 5));
  ASSERT_TRUE(recorder.stop().ok());
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")), (Lines{"/a@1=1", "/map@5=4", "/a@5=5"}));
  EXPECT_EQ(recorder.status().paused, 3U);
  EXPECT_EQ(recorder.status().dropped, 0U);
}

TEST(Recorder, ThePreTriggerWindowIsBoundedInTime) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.pre_trigger_s = 0.010;
  Recorder recorder(parameters, "run", disk.environment());
  EXPECT_EQ(recorder.status().state, RecorderState::kArmed);
  const auto a = recorder.add_topic(topic_of("a"));
  const auto map = recorder.add_topic(topic_of("map", true));
  (void)recorder.write(map, at_ms(1), {}, payload_of(1, 1));
  for (int ms = 2; ms <= 50; ++ms) {
    (void)recorder.write(a, at_ms(ms), {}, payload_of(1, ms));
  }
  EXPECT_TRUE(disk.files.empty());
  ASSERT_TRUE(recorder.trigger().ok());
  (void)recorder.write(a, at_ms(51), {}, payload_of(1, 51));
  ASSERT_TRUE(recorder.stop().ok());
  Lines expected = {"/map@40=1"};
  for (int ms = 40; ms <= 51; ++ms) {
    expected.push_back("/a@" + std::to_string(ms) + "=" + std::to_string(ms));
  }
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")), expected);
}

TEST(Recorder, ThePreTriggerWindowIsBoundedInBytes) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.pre_trigger_s = 1000;
  parameters.pre_trigger_mb = 1;
  Recorder recorder(parameters, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  for (int i = 0; i < 50; ++i) {
    (void)recorder.write(a, at_ms(i), {}, payload_of(100'000, i));
  }
  ASSERT_TRUE(recorder.trigger().ok());
  EXPECT_EQ(recorder.status().messages, 10U);
  EXPECT_EQ(recorder.status().expired, 40U);
  // Stopped without a trigger: nothing is written.
  Recorder armed(parameters, "other", disk.environment());
  ASSERT_TRUE(armed.stop().ok());
  EXPECT_EQ(disk.files.count("other_0.mcap"), 0U);
}

TEST(Recorder, StopsInGoodOrderBeforeTheDiskIsFull) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.min_free_mb = 100;
  Recorder recorder(parameters, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  ASSERT_TRUE(recorder.write(a, at_ms(1), {}, payload_of(5)).ok());
  ASSERT_TRUE(recorder.tick(at_ms(2)).ok());
  disk.free = 99'999'999;
  EXPECT_EQ(recorder.tick(at_ms(3)).error().code, ErrorCode::kIo);
  EXPECT_FALSE(recorder.write(a, at_ms(4), {}, payload_of(5)).ok());
  const auto status = recorder.status();
  EXPECT_EQ(status.state, RecorderState::kStopped);
  EXPECT_NE(status.fault.find("min_free_mb"), std::string::npos) << status.fault;
  EXPECT_EQ(status.messages, 1U);
  EXPECT_EQ(status.dropped, 1U);
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")).size(), 1U);
  EXPECT_THROW(Recorder(parameters, "more", disk.environment()), ConfigError);
}

TEST(Recorder, LooksAtTheDiskAlsoBetweenTicks) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.compression = "none";
  Recorder recorder(parameters, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  disk.free = 0;
  Status status;
  for (int i = 0; i < 100 && status; ++i) {
    status = recorder.write(a, at_ms(i), {}, payload_of(1'000'000));
  }
  EXPECT_FALSE(status.ok());
  EXPECT_LT(recorder.status().bytes, 20'000'000U);
}

TEST(Recorder, CountsWhatAFailedWriteTookWithIt) {
  /// Refuses after so many bytes.
  class Failing final : public mcap::Sink {
   public:
    Status write(std::span<const std::byte> bytes) override {
      written_ += bytes.size();
      return written_ < 250'000 ? Status() : Error{ErrorCode::kIo, "device is gone"};
    }
    Status truncate(std::uint64_t) override { return Error{ErrorCode::kIo, "still gone"}; }
    Status sync() override { return {}; }

   private:
    std::size_t written_ = 0;
  };
  TestDisk disk;
  auto environment = disk.environment();
  environment.create_file =
      [](const std::filesystem::path&) -> Result<std::unique_ptr<mcap::Sink>> {
    return std::unique_ptr<mcap::Sink>(std::make_unique<Failing>());
  };
  RecorderParameters parameters;
  parameters.compression = "none";
  parameters.chunk_kb = 100;
  Recorder recorder(parameters, "run", environment);
  const auto a = recorder.add_topic(topic_of("a"));
  for (int i = 0; i < 60; ++i) {
    (void)recorder.write(a, at_ms(i), {}, payload_of(10'000));
  }
  const auto status = recorder.status();
  EXPECT_EQ(status.state, RecorderState::kStopped);
  EXPECT_NE(status.fault.find("device is gone"), std::string::npos);
  EXPECT_EQ(status.messages + status.dropped, 60U);
  EXPECT_EQ(status.messages, 18U);  // two chunks of nine
}

TEST(Recorder, AKilledRecorderLosesAtMostFlushS) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.flush_s = 0.010;
  Recorder recorder(parameters, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  for (int ms = 0; ms <= 100; ++ms) {
    (void)recorder.write(a, at_ms(ms), {}, payload_of(5, ms));
  }
  (void)recorder.tick(at_ms(105));
  // The file as another process would find it now.
  const Bytes file = disk.files.at("run_0.mcap");
  const auto reader = mcap::Reader::open(mcap::memory_source(file));
  ASSERT_TRUE(reader.ok());
  EXPECT_NE(reader->damage(), "");
  EXPECT_GE(reader->summary().statistics->end_time, at_ms(95));
}

TEST(Recorder, RefusedMessagesAreCountedAndRecordingGoesOn) {
  TestDisk disk;
  Recorder recorder({}, "run", disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  EXPECT_EQ(recorder.write(a, at_ms(1), {}, nullptr).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(recorder.write(a, at_ms(-1), {}, payload_of(1)).error().code,
            ErrorCode::kInvalidArgument);
  EXPECT_TRUE(recorder.write(a, at_ms(2), {}, payload_of(1)).ok());
  EXPECT_EQ(recorder.status().dropped, 2U);
  EXPECT_EQ(recorder.status().messages, 1U);
}

TEST(Recorder, ExistingRecordingsAreNotOverwritten) {
  const Folder folder;
  std::ofstream(folder.path() / "run_0.mcap") << "precious";
  EXPECT_THROW(Recorder({}, folder.path() / "run"), ConfigError);
  std::ofstream(folder.path() / "file") << "no folder";
  EXPECT_THROW(Recorder({}, folder.path() / "file" / "run"), ConfigError);
  RecorderParameters parameters;
  parameters.min_free_mb = 0;
  Recorder recorder(parameters, folder.path() / "new" / "run");
  EXPECT_TRUE(recorder.stop().ok());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "new" / "run_0.mcap"));
}

}  // namespace
}  // namespace furrow::recording
