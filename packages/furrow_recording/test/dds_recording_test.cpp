#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_dds/test_domain.hpp"
#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/std_msgs.h"
#include "furrow_recording/dds_player.hpp"
#include "furrow_recording/dds_recorder.hpp"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

dds::DdsParameters on_loopback(const std::string& name) {
  dds::DdsParameters parameters;
  parameters.domain_id = dds::test_domain();
  parameters.process_name = name;
  parameters.shm_segment_mb = 16;
  return parameters;
}

/// Polls, for what has no event of its own: matches and counters.
bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    never.wait_for(lock, std::chrono::milliseconds(2));
  }
  return true;
}

using StringMessage = std_msgs::msg::String;

graph::MessagePtr text(const std::string& content) {
  auto message = std::make_shared<StringMessage>();
  message->data(content);
  return message;
}

/// What a reader of another process gets.
class TextReader {
 public:
  TextReader(dds::DdsTransport& transport, const std::string& topic, const msgs::Qos& qos)
      : reader_(transport.make_reader(
            topic, msgs::message_type<StringMessage>(), qos,
            [this](const graph::MessagePtr& message) {
              const std::lock_guard lock(mutex_);
              got_.push_back(static_cast<const StringMessage*>(message.get())->data());
            })) {}
  [[nodiscard]] Lines got() const {
    const std::lock_guard lock(mutex_);
    return got_;
  }

 private:
  mutable std::mutex mutex_;
  Lines got_;
  std::unique_ptr<graph::TransportReader> reader_;
};

class DdsRecording : public testing::Test {
 protected:
  DdsRecording() { parameters_.min_free_mb = 0; }

  Folder folder_;
  RecorderParameters parameters_;
};

TEST_F(DdsRecording, WhatIsRecordedIsPlayedAgain) {
  const msgs::MessageType& type = msgs::message_type<StringMessage>();
  const std::vector<std::byte> foreign = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0},
                                          std::byte{7}, std::byte{8}, std::byte{9}, std::byte{0}};
  RecorderStatus recorded;
  {
    dds::DdsTransport robot(on_loopback("robot"));
    dds::DdsTransport desk(on_loopback("desk"));
    parameters_.exclude = {"secret"};
    DdsRecorder recorder(desk, parameters_, folder_.path() / "run");
    const auto map = robot.make_writer("map", type, msgs::latched_qos());
    const auto pose = robot.make_writer("pose", type, msgs::event_qos());
    const auto secret = robot.make_writer("secret", type, msgs::event_qos());
    const auto thing = robot.make_raw_writer("//thing", "someones::Thing", msgs::event_qos());
    map->write(text("the field"));
    ASSERT_TRUE(eventually([&] { return pose->has_readers() && thing->has_readers(); }));
    for (int i = 0; i < 20; ++i) {
      pose->write(text("pose " + std::to_string(i)));
    }
    thing->write(std::make_shared<const std::vector<std::byte>>(foreign));
    ASSERT_TRUE(robot.flush(Duration::seconds(5)));
    EXPECT_TRUE(eventually([&] { return recorder.status().messages == 22; }));
    EXPECT_FALSE(secret->has_readers());
    ASSERT_TRUE(recorder.stop().ok());
    recorded = recorder.status();
    EXPECT_EQ(recorded.dropped, 0U);
    EXPECT_TRUE(recorder.skipped().empty());
  }
  ASSERT_EQ(recorded.files.size(), 1U);
  const auto source = mcap::open_file(recorded.files.front());
  ASSERT_TRUE(source.ok());
  EXPECT_EQ(mcap::verify(**source)->faults, Lines{});

  PlayerOptions options;
  options.rate = 100.0;
  options.remap = {{"pose", "pose_again"}};
  auto player = Player::open(recorded.files, options);
  ASSERT_TRUE(player.ok()) << player.error().message;
  dds::DdsTransport robot(on_loopback("robot"));
  dds::DdsTransport desk(on_loopback("desk"));
  TextReader poses(desk, "pose_again", msgs::event_qos());
  std::mutex mutex;
  std::vector<std::byte> got;
  const auto things = desk.make_raw_reader("//thing", "someones::Thing", msgs::event_qos(),
                                           [&](dds::RawMessage message) {
                                             const std::lock_guard lock(mutex);
                                             got = std::move(message.payload);
                                           });
  DdsPlayerOptions wait;
  wait.wait_for_readers = Duration::seconds(5);
  // Both topics' readers must be there: paused until they are.
  DdsPlayer play(robot, std::move(*player), wait);
  play.pause();
  ASSERT_TRUE(eventually([&] { return things->writers() == 1; }));
  ASSERT_TRUE(eventually([&] {
    for (const auto& status : robot.status()) {
      if (status.topic == "pose_again" || status.topic == "//thing") {
        if (status.peers == 0) {
          return false;
        }
      }
    }
    return true;
  }));
  play.seek(Time());
  play.resume();
  ASSERT_TRUE(play.wait(Duration::seconds(5)));
  // Latched: a late joiner gets it too.
  TextReader map(desk, "map", msgs::latched_qos());
  EXPECT_TRUE(eventually([&] { return poses.got().size() >= 20 && map.got().size() == 1; }));
  EXPECT_EQ(map.got(), Lines{"the field"});
  const Lines heard = poses.got();
  ASSERT_GE(heard.size(), 20U);
  EXPECT_EQ(heard.back(), "pose 19");
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return got == foreign;
  }));
  EXPECT_EQ(play.status().dropped, 0U);
  EXPECT_TRUE(play.status().finished);
}

TEST_F(DdsRecording, AWriterThatOffersLessJoinsAndIsRecordedToo) {
  const msgs::MessageType& type = msgs::message_type<StringMessage>();
  dds::DdsTransport robot(on_loopback("robot"));
  dds::DdsTransport desk(on_loopback("desk"));
  DdsRecorder recorder(desk, parameters_, folder_.path() / "run");
  const auto latched = robot.make_writer("state", type, msgs::latched_qos());
  ASSERT_TRUE(eventually([&] { return latched->has_readers(); }));
  const auto loose =
      robot.make_writer("state", type, {.reliability = msgs::Reliability::kBestEffort, .depth = 5});
  ASSERT_TRUE(eventually([&] { return loose->has_readers() && latched->has_readers(); }));
  loose->write(text("loose"));
  latched->write(text("latched"));
  EXPECT_TRUE(eventually([&] { return recorder.status().messages >= 2; }));
}

}  // namespace
}  // namespace furrow::recording
