#include "furrow_recording/player.hpp"

#include <gtest/gtest.h>

#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

struct Given {
  std::string topic;
  std::int64_t ms = 0;
  int value = 0;
};

/// As the recorder writes it; topics that begin with "map" are latched.
Bytes file_of(const std::vector<Given>& messages) {
  TestDisk disk;
  Recorder recorder({}, "run", disk.environment());
  for (const Given& message : messages) {
    const auto topic =
        recorder.add_topic(topic_of(message.topic, message.topic.starts_with("map")));
    EXPECT_TRUE(
        recorder.write(topic, at_ms(message.ms), at_ms(message.ms), payload_of(1, message.value))
            .ok());
  }
  EXPECT_TRUE(recorder.stop().ok());
  return disk.files.at("run_0.mcap");
}

std::unique_ptr<RecordingReader> readers_of(const std::vector<const Bytes*>& files) {
  std::vector<std::unique_ptr<RecordingReader>> readers;
  for (const Bytes* file : files) {
    readers.push_back(reader_of(*file));
  }
  return std::move(merge_readers(std::move(readers)).value());
}

Player open(const std::vector<const Bytes*>& files, const PlayerOptions& options = {}) {
  auto player = Player::open(readers_of(files), options);
  EXPECT_TRUE(player.ok()) << player.error().message;
  return std::move(player.value());
}

/// Plays from `now` until the end or for `span`, without sleeping. A line is "ms topic=value",
/// where ms is the caller's time. "!" marks repetitions, "clock ms" the clock, "wait" an endless
/// wait.
Lines play(Player& player, Time now, Duration span = Duration::seconds(100)) {
  Lines lines;
  const Time end = now + span;
  while (true) {
    auto event = player.next(now);
    if (!event) {
      lines.push_back("error");
      continue;
    }
    const std::string at = std::to_string(now.count_ns() / 1'000'000) + " ";
    if (const auto* message = std::get_if<PlayedMessage>(&*event)) {
      lines.push_back(at + (message->latched_again ? "!" : "") +
                      player.topics()[message->topic].name + "=" +
                      std::to_string(std::to_integer<int>((*message->payload)[0])));
    } else if (const auto* clock = std::get_if<PlayedClock>(&*event)) {
      lines.push_back(at + "clock " + std::to_string(clock->time.count_ns() / 1'000'000));
    } else if (const auto* wait = std::get_if<PlayerWait>(&*event)) {
      if (!wait->until) {
        lines.push_back("wait");
        return lines;
      }
      EXPECT_GT(*wait->until, now);
      if (*wait->until > end) {
        return lines;
      }
      now = *wait->until;
    } else {
      lines.push_back(at + "end");
      return lines;
    }
  }
}

const std::vector<Given> kDrive = {{"map", 1000, 1}, {"pose", 1010, 2}, {"pose", 1020, 3},
                                   {"map", 1030, 4}, {"pose", 1040, 5}, {"pose", 1050, 6}};

TEST(Player, MessagesComeAtTheirTimes) {
  const Bytes file = file_of(kDrive);
  Player player = open({&file});
  EXPECT_EQ(player.begin(), at_ms(1000));
  EXPECT_EQ(player.end(), at_ms(1050));
  EXPECT_EQ(play(player, at_ms(7)), (Lines{"7 map=1", "17 pose=2", "27 pose=3", "37 map=4",
                                           "47 pose=5", "57 pose=6", "57 end"}));
}

TEST(Player, RateScalesTime) {
  const Bytes file = file_of(kDrive);
  PlayerOptions options;
  options.rate = 0.1;
  Player player = open({&file}, options);
  Lines lines = play(player, at_ms(0), Duration::milliseconds(250));
  EXPECT_EQ(lines, (Lines{"0 map=1", "100 pose=2", "200 pose=3"}));
  EXPECT_EQ(player.position(at_ms(250)), at_ms(1025));
  ASSERT_TRUE(player.set_rate(at_ms(250), 5.0).ok());
  EXPECT_EQ(play(player, at_ms(250)), (Lines{"251 map=4", "253 pose=5", "255 pose=6", "255 end"}));
  EXPECT_FALSE(player.set_rate(at_ms(300), 0.0).ok());
  EXPECT_FALSE(player.set_rate(at_ms(300), -1.0).ok());
}

TEST(Player, FilesAreMergedByTime) {
  const Bytes first = file_of({{"a", 1, 1}, {"a", 3, 3}, {"a", 6, 6}});
  const Bytes second = file_of({{"a", 2, 2}, {"b", 4, 4}});
  const Bytes third = file_of({{"b", 5, 5}});
  Player player = open({&third, &first, &second});
  EXPECT_EQ(player.topics().size(), 2U);
  std::vector<int> values;
  while (true) {
    const auto next = player.next_message();
    ASSERT_TRUE(next.ok());
    if (!*next) {
      break;
    }
    values.push_back(std::to_integer<int>((*(*next)->payload)[0]));
  }
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3, 4, 5, 6}));
}

TEST(Player, AStartOffsetRepeatsWhatIsLatched) {
  const Bytes file = file_of(kDrive);
  PlayerOptions options;
  options.start_offset = Duration::milliseconds(35);
  options.duration = Duration::milliseconds(10);
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(0)), (Lines{"0 !map=4", "5 pose=5", "5 end"}));
}

TEST(Player, ASeekRepeatsWhatIsLatchedThen) {
  const Bytes file = file_of(kDrive);
  Player player = open({&file});
  EXPECT_EQ(play(player, at_ms(0), Duration::milliseconds(25)),
            (Lines{"0 map=1", "10 pose=2", "20 pose=3"}));
  player.seek(at_ms(25), at_ms(1045));
  EXPECT_EQ(play(player, at_ms(25)), (Lines{"25 !map=4", "30 pose=6", "30 end"}));
  player.seek(at_ms(100), at_ms(1020));
  EXPECT_EQ(play(player, at_ms(100), Duration::milliseconds(15)),
            (Lines{"100 !map=1", "100 pose=3", "110 map=4"}));
  player.seek(at_ms(200), at_ms(5));
  EXPECT_EQ(play(player, at_ms(200), Duration()), (Lines{"200 map=1"}));
}

TEST(Player, LoopsBeginAgainAtOnce) {
  const Bytes file = file_of(kDrive);
  PlayerOptions options;
  options.loop = true;
  options.start_offset = Duration::milliseconds(30);
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(0), Duration::milliseconds(35)),
            (Lines{"0 !map=1", "0 map=4", "10 pose=5", "20 pose=6", "20 !map=1", "20 map=4",
                   "30 pose=5"}));
  EXPECT_EQ(player.loops(), 1U);
}

TEST(Player, ALoopOfOneMessageHasAPeriod) {
  const Bytes file = file_of({{"pose", 1000, 1}});
  PlayerOptions options;
  options.loop = true;
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(0), Duration::milliseconds(2500)),
            (Lines{"0 pose=1", "1000 pose=1", "2000 pose=1"}));
  options.rate = 4.0;
  Player fast = open({&file}, options);
  EXPECT_EQ(play(fast, at_ms(0), Duration::milliseconds(600)),
            (Lines{"0 pose=1", "250 pose=1", "500 pose=1"}));
}

TEST(Player, ALoopShorterThanATickHasAPeriodToo) {
  const Bytes file = file_of({{"map", 1000, 1}, {"pose", 1001, 2}});
  PlayerOptions options;
  options.loop = true;
  options.start_offset = Duration::milliseconds(1);
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(0), Duration::milliseconds(1500)),
            (Lines{"0 !map=1", "0 pose=2", "1000 !map=1", "1000 pose=2"}));
}

TEST(Player, TopicsThatAreNotCdrAreNotPlayedAndTold) {
  Bytes file;
  auto writer = std::move(mcap::Writer::open(mcap::memory_sink(file)).value());
  const auto schema = writer->add_schema("pkg/msg/Type", "ros2msg", "");
  const auto json = writer->add_channel({0, *schema, "/json", "json", {}});
  const auto other = writer->add_channel({0, *schema, "/other", "wrong_format", {}});
  const auto unknown = writer->add_channel({0, 0, "/typeless", "cdr", {}});
  const auto good = writer->add_channel({0, *schema, "/good", "cdr", {}});
  const Bytes data(8);
  for (const auto& channel : {json, json, other, unknown, good}) {
    ASSERT_TRUE(writer->write({*channel, 0, at_ms(1), at_ms(1), data}).ok());
  }
  ASSERT_TRUE(writer->close().ok());
  Player player = open({&file});
  ASSERT_EQ(player.topics().size(), 1U);
  EXPECT_EQ(player.topics().front().name, "good");
  ASSERT_EQ(player.unplayable().size(), 3U);
  EXPECT_EQ(player.unplayable()[0].name, "json");
  EXPECT_EQ(player.unplayable()[0].messages, 2U);
  EXPECT_NE(player.unplayable()[0].reason.find("json"), std::string::npos);
  EXPECT_EQ(play(player, at_ms(0)), (Lines{"0 good=0", "0 end"}));
}

TEST(Player, MisspelledPatternsAreTold) {
  const Bytes file = file_of(kDrive);
  PlayerOptions options;
  options.topics.include = {"map", "poze"};
  EXPECT_EQ(open({&file}, options).unmatched_patterns(), Lines{"poze"});
}

TEST(Player, AnUnfinishedFileIsTold) {
  Bytes file = file_of(kDrive);
  EXPECT_EQ(open({&file}).recording().damage, "");
  file.resize(file.size() - 100);
  EXPECT_NE(open({&file}).recording().damage, "");
}

TEST(Player, StaticTransformsOfSeveralPublishersAreOneTopic) {
  Bytes file;
  auto writer = std::move(mcap::Writer::open(mcap::memory_sink(file)).value());
  TopicDescription topic = topic_of("map", true);
  const auto schema = writer->add_schema(topic.type_name, "ros2msg", "");
  for (int i = 1; i <= 3; ++i) {
    topic.publisher = "node" + std::to_string(i);
    const auto channel = writer->add_channel({0, *schema, "/map", "cdr", channel_metadata(topic)});
    const Bytes data(1, static_cast<std::byte>(i));
    ASSERT_TRUE(writer->write({*channel, 0, at_ms(i), at_ms(i), data}).ok());
  }
  const auto pose = writer->add_channel({0, *schema, "/pose", "cdr", {}});
  const Bytes data(1);
  ASSERT_TRUE(writer->write({*pose, 0, at_ms(100), at_ms(100), data}).ok());
  ASSERT_TRUE(writer->close().ok());
  PlayerOptions options;
  options.start_offset = Duration::milliseconds(50);
  Player player = open({&file}, options);
  ASSERT_EQ(player.topics().size(), 2U);
  EXPECT_EQ(player.topics().front().offered_qos.size(), 3U);
  EXPECT_EQ(play(player, at_ms(0), Duration()), (Lines{"0 !map=1", "0 !map=2", "0 !map=3"}));
}

TEST(Player, PausesStepsAndResumes) {
  const Bytes file = file_of(kDrive);
  PlayerOptions options;
  options.start_paused = true;
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(0)), (Lines{"wait"}));
  player.step(2);
  EXPECT_EQ(play(player, at_ms(500)), (Lines{"500 map=1", "500 pose=2", "wait"}));
  EXPECT_EQ(player.position(at_ms(900)), at_ms(1010));
  player.resume(at_ms(1000));
  EXPECT_EQ(play(player, at_ms(1000), Duration::milliseconds(15)), (Lines{"1010 pose=3"}));
  player.pause(at_ms(1015));
  EXPECT_EQ(player.position(at_ms(9000)), at_ms(1025));
  player.resume(at_ms(2000));
  EXPECT_EQ(play(player, at_ms(2000)),
            (Lines{"2005 map=4", "2015 pose=5", "2025 pose=6", "2025 end"}));
}

TEST(Player, TopicsAreFilteredAndRemapped) {
  const Bytes file = file_of(kDrive);
  PlayerOptions options;
  options.topics.exclude = {"/map"};
  options.remap = {{"/pose", "/old/pose"}};
  Player player = open({&file}, options);
  ASSERT_EQ(player.topics().size(), 1U);
  EXPECT_EQ(player.topics().front().name, "old/pose");
  EXPECT_EQ(play(player, at_ms(0)).size(), 5U);
}

TEST(Player, TheClockTicksInTheRecordingsTime) {
  const Bytes file = file_of({{"a", 0, 1}, {"a", 25, 2}});
  PlayerOptions options;
  options.clock_hz = 100;
  options.rate = 2.0;
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(0)),
            (Lines{"0 clock 0", "0 a=1", "5 clock 10", "10 clock 20", "12 a=2", "12 end"}));
}

TEST(Player, ALateCallerGetsAllMessagesInOrder) {
  const Bytes file = file_of(kDrive);
  Player player = open({&file});
  EXPECT_EQ(play(player, at_ms(0), Duration()).size(), 1U);
  EXPECT_EQ(play(player, at_ms(500)), (Lines{"500 pose=2", "500 pose=3", "500 map=4", "500 pose=5",
                                             "500 pose=6", "500 end"}));
}

TEST(Player, ADamagedChunkIsAnErrorAndPlayingGoesOn) {
  TestDisk disk;
  RecorderParameters parameters;
  parameters.flush_s = 0.01;
  Recorder recorder(parameters, "run", disk.environment());
  const auto topic = recorder.add_topic(topic_of("a"));
  for (int ms = 0; ms <= 100; ms += 5) {
    (void)recorder.write(topic, at_ms(ms), {}, payload_of(1, ms));
  }
  ASSERT_TRUE(recorder.stop().ok());
  Bytes& file = disk.files.at("run_0.mcap");
  const auto chunk = mcap::Reader::open(mcap::memory_source(file))->summary().chunks.at(2);
  file[static_cast<std::size_t>(chunk.offset + chunk.length - 6)] ^= std::byte{1};
  Player player = open({&file});
  const Lines lines = play(player, at_ms(0));
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "error"), 1);
  EXPECT_EQ(lines.back(), "100 end");
  EXPECT_EQ(lines.size(), 21U - 3U + 2U);
}

TEST(Player, WhatCannotBePlayedIsRefused) {
  const Bytes file = file_of(kDrive);
  const auto refused = [&file](const PlayerOptions& options) {
    const auto player = Player::open(reader_of(file), options);
    return !player.ok() && player.error().code == ErrorCode::kInvalidArgument;
  };
  EXPECT_TRUE(refused({.rate = 0.0}));
  EXPECT_TRUE(refused({.rate = std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_TRUE(refused({.start_offset = Duration::seconds(1)}));
  EXPECT_TRUE(refused({.start_offset = Duration::seconds(-1)}));
  EXPECT_TRUE(refused({.duration = Duration::seconds(-1)}));
  EXPECT_TRUE(refused({.clock_hz = -1.0}));
  EXPECT_EQ(Player::open(std::vector<std::filesystem::path>{}, {}).error().code,
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(Player::open({std::filesystem::path("missing.mcap")}, {}).error().code,
            ErrorCode::kNotFound);
  const Bytes noise(100, std::byte{3});
  EXPECT_EQ(open_recording(mcap::memory_source(noise)).error().code, ErrorCode::kParse);
}

TEST(Player, AnEmptyRecordingEndsAtOnce) {
  const Bytes file = file_of({});
  PlayerOptions options;
  options.loop = true;
  Player player = open({&file}, options);
  EXPECT_EQ(play(player, at_ms(3)), (Lines{"3 end"}));
}

}  // namespace
}  // namespace furrow::recording
