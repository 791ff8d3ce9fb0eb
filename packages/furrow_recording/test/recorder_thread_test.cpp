#include "furrow_recording/recorder_thread.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/std_msgs.h"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

/// A disk that stands still until it is released.
class Gate {
 public:
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

TEST(RecorderThread, WritesFromManyThreadsAndLosesNothing) {
  TestDisk disk;
  {
    RecorderThread recorder({}, "run", RecorderClock::kReal, disk.environment());
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&recorder, t] {
        const auto topic = recorder.add_topic(topic_of("t" + std::to_string(t)));
        for (int i = 0; i < 500; ++i) {
          EXPECT_TRUE(recorder.record(topic, at_ms(i), at_ms(i), payload_of(10, i % 256)));
        }
      });
    }
    for (auto& thread : threads) {
      thread.join();
    }
    recorder.drain();
    EXPECT_EQ(recorder.status().messages, 2000U);
  }
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")).size(), 2000U);
}

TEST(RecorderThread, AFullQueueDropsAndCountsAndNeverBlocks) {
  TestDisk disk;
  Gate gate;
  auto environment = disk.environment();
  const auto free_bytes = environment.free_bytes;
  int asked = 0;
  environment.free_bytes = [&](const std::filesystem::path& path) {
    if (++asked == 2) {
      gate.wait();
    }
    return free_bytes(path);
  };
  RecorderParameters parameters;
  parameters.compression = "none";
  parameters.queue_mb = 40;
  RecorderThread recorder(parameters, "run", RecorderClock::kReal, environment);
  const auto topic = recorder.add_topic(topic_of("a"));
  int accepted = 0;
  for (int i = 0; i < 100; ++i) {
    accepted += recorder.record(topic, at_ms(i), {}, payload_of(1'000'000)) ? 1 : 0;
  }
  EXPECT_GE(accepted, 40);
  EXPECT_LT(accepted, 80);
  gate.open();
  recorder.drain();
  EXPECT_EQ(recorder.status().messages, static_cast<std::uint64_t>(accepted));
  EXPECT_EQ(recorder.status().dropped, static_cast<std::uint64_t>(100 - accepted));
}

TEST(RecorderThread, SerializesMessagesOfComponents) {
  TestDisk disk;
  auto message = std::make_shared<std_msgs::msg::String>();
  message->data("hello");
  const auto& type = msgs::message_type<std_msgs::msg::String>();
  RecorderThread recorder({}, "run", RecorderClock::kReal, disk.environment());
  const auto topic = recorder.add_topic(
      describe_topic("text", type.ros_name, {msgs::event_qos()}, SchemaStyle::kRos2msg));
  EXPECT_TRUE(recorder.record(topic, at_ms(1), at_ms(1), message, type));
  EXPECT_TRUE(recorder.stop().ok());
  EXPECT_FALSE(recorder.record(topic, at_ms(2), at_ms(2), message, type) &&
               (recorder.drain(), recorder.status().dropped == 0));
  const Bytes& file = disk.files.at("run_0.mcap");
  const auto reader = mcap::Reader::open(mcap::memory_source(file));
  auto cursor = reader->messages();
  const auto read = cursor.next();
  ASSERT_TRUE(read.ok() && read->has_value());
  std_msgs::msg::String back;
  ASSERT_TRUE(type.deserialize((*read)->data, &back).ok());
  EXPECT_EQ(back.data(), "hello");
  EXPECT_EQ(reader->summary().schemas.at(1).data, "string data\n");
}

TEST(RecorderThread, WaitsForRoomWhereEveryMessageCounts) {
  TestDisk disk;
  const auto& type = msgs::message_type<std_msgs::msg::String>();
  RecorderParameters parameters;
  parameters.queue_messages = 1;
  parameters.queue_mb = 1.0;
  RecorderThread recorder(parameters, "run", RecorderClock::kSimulated, disk.environment());
  const auto topic = recorder.add_topic(
      describe_topic("text", type.ros_name, {msgs::event_qos()}, SchemaStyle::kRos2msg));
  // The second is larger than the whole queue.
  for (int i = 0; i < 300; ++i) {
    auto message = std::make_shared<std_msgs::msg::String>();
    message->data(std::string(i == 1 ? 2'000'000 : 100, 'x'));
    EXPECT_TRUE(recorder.record(topic, at_ms(i), at_ms(i), message, type));
  }
  EXPECT_TRUE(recorder.stop().ok());
  EXPECT_EQ(recorder.status().messages, 300U);
  EXPECT_EQ(recorder.status().dropped, 0U);
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")).size(), 300U);
}

TEST(RecorderThread, CommandsComeInOrderWithMessages) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.pre_trigger_s = 1.0;
  RecorderThread recorder(parameters, "run", RecorderClock::kReal, disk.environment());
  const auto a = recorder.add_topic(topic_of("a"));
  (void)recorder.record(a, at_ms(1), {}, payload_of(1, 1));
  recorder.trigger();
  (void)recorder.record(a, at_ms(2), {}, payload_of(1, 2));
  recorder.pause();
  (void)recorder.record(a, at_ms(3), {}, payload_of(1, 3));
  recorder.resume();
  (void)recorder.record(a, at_ms(4), {}, payload_of(1, 4));
  EXPECT_TRUE(recorder.stop().ok());
  EXPECT_EQ(content_of(disk.files.at("run_0.mcap")), (Lines{"/a@1=1", "/a@2=2", "/a@4=4"}));
}

}  // namespace
}  // namespace furrow::recording
