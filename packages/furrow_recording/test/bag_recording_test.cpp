#include <gtest/gtest.h>

#include <algorithm>

#include "furrow_core/random.hpp"
#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/std_msgs.h"
#include "furrow_recording/recording_copy.hpp"
#include "furrow_recording/recording_summary.hpp"
#include "recording_test_support.hpp"
#include "test_bag.hpp"

namespace furrow::recording {
namespace {

/// "topic@ms=text" of std_msgs/String messages.
Lines texts_of(const RecordingReader& reader, const mcap::ReadOptions& options = {},
               int* errors = nullptr) {
  Lines lines;
  const auto stream = reader.messages(options);
  while (true) {
    const auto next = stream->next();
    if (!next) {
      EXPECT_NE(errors, nullptr) << next.error().message;
      if (errors == nullptr) return lines;
      ++*errors;
      continue;
    }
    if (!*next) return lines;
    const mcap::Message& message = **next;
    std_msgs::msg::String text;
    EXPECT_TRUE(msgs::message_type<std_msgs::msg::String>().deserialize(message.data, &text).ok());
    lines.push_back(reader.info().summary.channels.at(message.channel_id).topic + "@" +
                    std::to_string(message.log_time.count_ns() / 1'000'000) + "=" + text.data());
  }
}

mcap::Bytes ros1_text(const std::string& text) {
  return Ros1Message().text(text).bytes;
}

/// Two publishers of /map, one of /pose, in chunks of five messages that overlap in time.
TestBag small_bag(const std::string& compression, int messages = 20) {
  TestBag bag(compression);
  const auto map = bag.connect("/map", "std_msgs/String", "string data\n", true, "/mapper");
  const auto again = bag.connect("/map", "std_msgs/String", "string data\n", true, "/other");
  const auto pose = bag.connect("/pose", "std_msgs/String", "string data\n");
  for (int i = 0; i < messages; ++i) {
    const int ms = i % 5 == 0 ? 10 * i : 10 * (i % 2 == 0 ? i : i + 3);
    const auto nsec = static_cast<std::uint32_t>(ms * 1'000'000);
    const std::uint32_t to = i == 0 ? map : i == 1 ? again : pose;
    bag.message(to, 1, nsec, ros1_text(std::to_string(i)));
    if (i % 5 == 4) bag.end_chunk();
  }
  return bag;
}

Lines expected_texts(int messages = 20) {
  std::vector<std::pair<int, std::string>> lines;
  for (int i = 0; i < messages; ++i) {
    const int ms = 1000 + (i % 5 == 0 ? 10 * i : 10 * (i % 2 == 0 ? i : i + 3));
    lines.emplace_back(ms,
                       (i < 2 ? "/map@" : "/pose@") + std::to_string(ms) + "=" + std::to_string(i));
  }
  std::ranges::stable_sort(lines, {}, &std::pair<int, std::string>::first);
  Lines texts;
  for (const auto& [ms, text] : lines) texts.push_back(text);
  return texts;
}

TEST(BagRecording, MessagesOfAllCompressionsComeInOrder) {
  for (const char* compression : {"none", "bz2", "lz4"}) {
    SCOPED_TRACE(compression);
    TestBag bag = small_bag(compression);
    const auto reader = reader_of(bag.close());
    const RecordingInfo& info = reader->info();
    EXPECT_TRUE(info.whole()) << info.damage;
    EXPECT_EQ(info.format, "rosbag1");
    EXPECT_EQ(info.compressions, std::set<std::string>{compression});
    EXPECT_EQ(info.statistics().message_count, 20U);
    EXPECT_EQ(info.statistics().chunk_count, 4U);
    EXPECT_EQ(info.statistics().start_time, at_ms(1000));
    EXPECT_EQ(texts_of(*reader), expected_texts());
    mcap::ReadOptions options;
    options.begin = at_ms(1050);
    options.end = at_ms(1100);
    options.accept = [](const mcap::Channel& channel) { return channel.topic == "/pose"; };
    for (const std::string& line : texts_of(*reader, options)) {
      EXPECT_TRUE(line >= "/pose@1050" && line < "/pose@1100") << line;
    }
  }
}

TEST(BagRecording, PublishersAreChannelsAndLatchingIsTransientLocal) {
  TestBag bag = small_bag("none");
  const auto reader = reader_of(bag.close());
  const auto topics = summarize_topics(reader->info());
  ASSERT_EQ(topics.size(), 2U);
  EXPECT_EQ(topics[0].topic, "map");
  EXPECT_EQ(topics[0].type, "std_msgs/msg/String");
  EXPECT_EQ(topics[0].quality, "reliable, latched");
  EXPECT_EQ(topics[0].channels, 2U);
  EXPECT_EQ(topics[1].quality, "reliable");
  Bytes copied;
  auto writer = std::move(mcap::Writer::open(mcap::memory_sink(copied)).value());
  Selection selection;
  selection.from_s = 0.1;
  const auto report = copy_recording(*reader, *writer, selection);
  ASSERT_TRUE(report.ok()) << report.error().message;
  ASSERT_TRUE(writer->close().ok());
  EXPECT_EQ(report->latched, 2U) << "one of each publisher";
  EXPECT_EQ(mcap::verify(*mcap::memory_source(copied))->faults, Lines());
}

TEST(BagRecording, ABagWithoutIndexIsReadToItsEnd) {
  for (const char* compression : {"none", "lz4"}) {
    TestBag bag = small_bag(compression);
    const auto reader = reader_of(bag.bytes);  // not closed
    EXPECT_NE(reader->info().damage, "");
    EXPECT_EQ(texts_of(*reader), expected_texts());
  }
  TestBag bag;
  const auto pose = bag.connect("/pose", "std_msgs/String", "string data\n");
  bag.message(pose, 1, 0, ros1_text("a"));
  bag.end_chunk(false);
  EXPECT_EQ(texts_of(*reader_of(bag.bytes)), Lines{"/pose@1000=a"});
}

TEST(BagRecording, EveryTruncationGivesAnErrorOrAPrefix) {
  TestBag bag = small_bag("lz4");
  const Bytes whole = bag.close();
  const Lines expected = expected_texts();
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto reader = open_recording(mcap::memory_source(std::span(whole).first(size)));
    if (!reader) {
      EXPECT_EQ(reader.error().code, ErrorCode::kParse);
      EXPECT_LT(size, 4200U);
      continue;
    }
    EXPECT_NE((*reader)->info().damage, "") << size;
    for (const std::string& line : texts_of(**reader)) {
      EXPECT_NE(std::ranges::find(expected, line), expected.end()) << line;
    }
  }
}

TEST(BagRecording, RandomChangesNeverCrash) {
  for (const char* compression : {"none", "bz2", "lz4"}) {
    TestBag bag = small_bag(compression);
    const Bytes whole = bag.close();
    Random random(3, compression);
    for (int i = 0; i < 300; ++i) {
      Bytes file = whole;
      for (auto changes = random.integer(1, 6); changes > 0; --changes) {
        const auto at = static_cast<std::size_t>(
            random.integer(i % 2 == 0 ? 13 : 4096, static_cast<std::int64_t>(file.size()) - 1));
        file[at] = random.bernoulli(0.5) ? std::byte{0xFF} : static_cast<std::byte>(random.next());
      }
      for (const bool scan : {false, true}) {
        OpenOptions options;
        options.scan = scan;
        const auto reader = open_recording(mcap::memory_source(file), options);
        if (!reader) continue;
        const auto stream = (*reader)->messages({});
        for (auto next = stream->next(); !next || *next; next = stream->next()) {
        }
      }
    }
  }
}

TEST(BagRecording, AWrongIndexIsFoundAndNotUsed) {
  TestBag bag = small_bag("none");
  Bytes file = bag.close();
  // The first entry of the first index: another time.
  const std::string op("op=\x04", 4);
  const auto view = std::string_view(reinterpret_cast<const char*>(file.data()), file.size());
  const std::size_t header = view.find(op);
  const std::size_t data = view.find("ver=", header) + 8 + 4;
  file[data] ^= std::byte{1};
  const auto reader = reader_of(file);
  EXPECT_EQ(texts_of(*reader), expected_texts());
  EXPECT_FALSE(reader->info().faults.empty());
}

TEST(BagRecording, ATypeThatCannotBeTranslatedIsLeftOutAndTold) {
  TestBag bag;
  const auto good = bag.connect("/good", "std_msgs/String", "string data\n");
  const auto bad = bag.connect("/bad", "p/Bad", "Missing m\n");
  bag.message(good, 1, 0, ros1_text("a"));
  bag.message(bad, 2, 0, ros1_text("b"));
  bag.message(good, 3, 0, {std::byte{1}});  // cut short
  const auto reader = reader_of(bag.close());
  ASSERT_EQ(reader->info().faults.size(), 2U);
  EXPECT_NE(reader->info().faults[0].find("/bad"), std::string::npos);
  int errors = 0;
  EXPECT_EQ(texts_of(*reader, {}, &errors), Lines{"/good@1000=a"});
  EXPECT_EQ(errors, 1);
}

TEST(BagRecording, OtherVersionsAreNamed) {
  for (const char* head : {"#ROSBAG V1.2\n", "#ROSBAG V2.1\n"}) {
    std::string text = head + std::string(100, ' ');
    const auto view = std::as_bytes(std::span(text));
    const auto reader = open_recording(mcap::memory_source(view));
    ASSERT_FALSE(reader.ok());
    EXPECT_NE(reader.error().message.find("version"), std::string::npos);
  }
}

/// Bags of robots, not part of the project (see docs/how_to/build_and_test.md).
TEST(BagRecording, RealBagsAreReadWhole) {
  const char* const given = std::getenv("FURROW_DATA_DIR");
  const std::filesystem::path folder =
      given != nullptr ? given : FURROW_TEST_DATA_DIR "/../../../../shared/data";
  struct Counts {
    const char* file;
    std::uint64_t messages;
    std::map<std::string, std::uint64_t> topics;
  };
  bool any = false;
  for (const char* file : {"test1.bag", "test2.bag"}) {
    const auto path = folder / "robot_logs" / file;
    if (!std::filesystem::exists(path)) continue;
    any = true;
    const auto report = verify_recording(path);
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_EQ(report->faults, Lines());
    const auto reader = std::move(open_recording(path).value());
    EXPECT_EQ(report->messages, reader->info().statistics().message_count);
    EXPECT_GT(report->messages, 1000U);
    for (const TopicSummary& topic : summarize_topics(reader->info())) {
      EXPECT_TRUE(topic.type == "sensor_msgs/msg/Imu" || topic.type == "nav_msgs/msg/Odometry" ||
                  topic.type == "sensor_msgs/msg/NavSatFix")
          << topic.type;
    }
  }
  if (!any) GTEST_SKIP() << "no bags in " << folder << "/robot_logs; set FURROW_DATA_DIR";
}

}  // namespace
}  // namespace furrow::recording
