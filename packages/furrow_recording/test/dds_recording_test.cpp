#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>

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

/// Polls a condition without an event: matches and counters.
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

/// A reader in another process, with its messages.
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

/// A message of a type that Furrow was not built with.
Payload foreign_message() {
  return std::make_shared<const Bytes>(Bytes{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0},
                                             std::byte{7}, std::byte{8}, std::byte{9},
                                             std::byte{0}});
}
constexpr char kForeignTopic[] = "//thing";
constexpr char kForeignType[] = "someones::Thing";

/// Records a latched map, twenty poses and a foreign message; not the topic "secret".
RecorderStatus record_drive(RecorderParameters parameters, const std::filesystem::path& stem) {
  const msgs::MessageType& type = msgs::message_type<StringMessage>();
  dds::DdsTransport robot(on_loopback("robot"));
  dds::DdsTransport desk(on_loopback("desk"));
  parameters.exclude = {"secret"};
  DdsRecorder recorder(desk, parameters, stem);
  const auto map = robot.make_writer("map", type, msgs::latched_qos());
  const auto pose = robot.make_writer("pose", type, msgs::event_qos());
  const auto secret = robot.make_writer("secret", type, msgs::event_qos());
  const auto thing = robot.make_raw_writer(kForeignTopic, kForeignType, msgs::event_qos());
  map->write(text("the field"));
  EXPECT_TRUE(eventually([&] { return pose->has_readers() && thing->has_readers(); }));
  for (int i = 0; i < 20; ++i) {
    pose->write(text("pose " + std::to_string(i)));
  }
  thing->write(foreign_message());
  EXPECT_TRUE(robot.flush(Duration::seconds(5)));
  EXPECT_TRUE(eventually([&] { return recorder.status().messages == 22; }));
  EXPECT_FALSE(secret->has_readers());
  EXPECT_TRUE(recorder.stop().ok());
  EXPECT_EQ(recorder.status().dropped, 0U);
  EXPECT_TRUE(recorder.skipped().empty());
  return recorder.status();
}

bool have_readers(const dds::DdsTransport& transport, const std::set<std::string>& topics) {
  return std::ranges::none_of(transport.status(), [&topics](const dds::EndpointStatus& status) {
    return topics.contains(status.topic) && status.peers == 0;
  });
}

TEST_F(DdsRecording, RecordedTopicsArePlayedAgain) {
  const RecorderStatus recorded = record_drive(parameters_, folder_.path() / "run");
  ASSERT_EQ(recorded.files.size(), 1U);
  EXPECT_EQ(mcap::verify(*mcap::open_file(recorded.files.front()).value())->faults, Lines{});

  PlayerOptions options;
  options.rate = 100.0;
  options.remap = {{"pose", "pose_again"}};
  auto player = Player::open(recorded.files, options);
  ASSERT_TRUE(player.ok()) << player.error().message;
  dds::DdsTransport robot(on_loopback("robot"));
  dds::DdsTransport desk(on_loopback("desk"));
  TextReader poses(desk, "pose_again", msgs::event_qos());
  std::mutex mutex;
  Bytes got;
  const auto things = desk.make_raw_reader(kForeignTopic, kForeignType, msgs::event_qos(),
                                           [&](dds::RawMessage message) {
                                             const std::lock_guard lock(mutex);
                                             got = std::move(message.payload);
                                           });
  DdsPlayer play(robot, std::move(*player), {.wait_for_readers = Duration::seconds(5)});
  // Paused until the readers of both topics are matched.
  play.pause();
  ASSERT_TRUE(eventually([&] { return things->writers() == 1; }));
  ASSERT_TRUE(eventually([&] { return have_readers(robot, {"pose_again", kForeignTopic}); }));
  play.seek(Time());
  play.resume();
  ASSERT_TRUE(play.wait(Duration::seconds(5)));
  // Latched: a late joiner gets it too.
  TextReader map(desk, "map", msgs::latched_qos());
  EXPECT_TRUE(eventually([&] { return poses.got().size() >= 20 && map.got().size() == 1; }));
  EXPECT_EQ(map.got(), Lines{"the field"});
  ASSERT_GE(poses.got().size(), 20U);
  EXPECT_EQ(poses.got().back(), "pose 19");
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return got == *foreign_message();
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

TEST_F(DdsRecording, PublishersOfALatchedTopicHaveTheirOwnChannels) {
  const msgs::MessageType& type = msgs::message_type<StringMessage>();
  dds::DdsTransport first(on_loopback("first"));
  dds::DdsTransport second(on_loopback("second"));
  dds::DdsTransport desk(on_loopback("desk"));
  DdsRecorder recorder(desk, parameters_, folder_.path() / "run");
  const auto one = first.make_writer("map", type, msgs::latched_qos());
  const auto two = second.make_writer("map", type, msgs::latched_qos());
  one->write(text("one"));
  two->write(text("two"));
  ASSERT_TRUE(eventually([&] { return recorder.status().messages == 2; }));
  ASSERT_TRUE(recorder.stop().ok());
  const auto reader = open_recordings(recorder.status().files);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ((*reader)->info().summary.channels.size(), 2U);
}

TEST_F(DdsRecording, APlayerThatAlwaysHasAMessageDueStopsAtOnce) {
  Bytes file;
  {
    TestDisk disk;
    Recorder recorder({}, "run", disk.environment());
    const auto topic = recorder.add_topic(topic_of("pose"));
    for (int i = 0; i < 2000; ++i) {
      (void)recorder.write(topic, at_ms(10 * i), at_ms(10 * i), payload_of(8));
    }
    ASSERT_TRUE(recorder.stop().ok());
    file = disk.files.at("run_0.mcap");
  }
  PlayerOptions options;
  options.loop = true;
  options.rate = 1000.0;
  auto player = Player::open(reader_of(file), options);
  ASSERT_TRUE(player.ok());
  dds::DdsTransport robot(on_loopback("robot"));
  dds::DdsTransport desk(on_loopback("desk"));
  const auto reader = desk.make_raw_reader("pose", "pkg::msg::dds_::Type_", msgs::event_qos(),
                                           [](dds::RawMessage) {});
  DdsPlayer play(robot, std::move(*player), {});
  ASSERT_TRUE(eventually([&] { return play.status().messages > 3000; })) << "it loops";
  play.pause();
  const std::uint64_t messages = play.status().messages;
  EXPECT_EQ(play.status().messages, messages);
  play.resume();
  play.stop();  // and the destructor, neither of which may hang
}

}  // namespace
}  // namespace furrow::recording
