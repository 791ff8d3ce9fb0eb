#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "test_support.hpp"

namespace furrow::dds {
namespace {

using Transports = std::vector<std::string>;

// Participants of one process would deliver messages to each other without a transport.
class SeparateParticipants : public ::testing::Environment {
 public:
  void SetUp() override {
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  }
};
[[maybe_unused]] const auto* const environment =
    ::testing::AddGlobalTestEnvironment(new SeparateParticipants);

class RoundTrip : public ::testing::TestWithParam<Transports> {};

INSTANTIATE_TEST_SUITE_P(Transports, RoundTrip,
                         ::testing::Values(Transports{"shm"}, Transports{"udp"},
                                           Transports{"shm", "udp"}));

TEST_P(RoundTrip, SmallMessagesArriveInOrder) {
  DdsTransport a(test_parameters("a", GetParam()));
  DdsTransport b(test_parameters("b", GetParam()));
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  const auto writer = a.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  std::vector<std::string> expected;
  for (int i = 0; i < 200; ++i) {
    expected.push_back("message " + std::to_string(i));
    writer->write(make_string(expected.back()));
  }
  ASSERT_TRUE(inbox.wait_for(expected.size()));
  EXPECT_EQ(inbox.items(), expected);
  EXPECT_TRUE(a.flush(Duration::seconds(5)));
  EXPECT_EQ(writer->counters().messages, expected.size());
  EXPECT_EQ(reader->counters().messages, expected.size());
  // DDS pads each message to four bytes.
  EXPECT_GE(reader->counters().bytes, writer->counters().bytes);
  EXPECT_LE(reader->counters().bytes, writer->counters().bytes + 3 * expected.size());
  EXPECT_EQ(reader->counters().dropped, 0U);
}

TEST_P(RoundTrip, AnImageOfSixMegabytesArrivesWhole) {
  DdsTransport a(test_parameters("a", GetParam()));
  DdsTransport b(test_parameters("b", GetParam()));
  Inbox<graph::MessagePtr> inbox;
  const auto reader = b.make_reader("image", image_type(), msgs::sensor_stream_qos(),
                                    [&](graph::MessagePtr message) { inbox.put(message); });
  const auto writer = a.make_writer("image", image_type(), msgs::sensor_stream_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto image = make_image(6'000'000, i);
    writer->write(image);
    ASSERT_TRUE(inbox.wait_for(i + 1)) << "image " << i;
    EXPECT_TRUE(*static_cast<const Image*>(inbox.items().back().get()) == *image);
  }
}

TEST_F(TwoProcesses, AMessageWithAHolderIsNotReused) {
  Inbox<graph::MessagePtr> held;
  const auto reader = b_.make_reader("image", image_type(), msgs::event_qos(),
                                     [&](graph::MessagePtr message) { held.put(message); });
  const auto writer = a_.make_writer("image", image_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  std::vector<std::shared_ptr<const Image>> sent;
  for (std::uint32_t i = 0; i < 12; ++i) {
    sent.push_back(make_image(200'000, i));
    writer->write(sent.back());
  }
  ASSERT_TRUE(held.wait_for(sent.size()));
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_TRUE(*static_cast<const Image*>(held.items()[i].get()) == *sent[i]) << i;
  }
}

TEST(Transport, AWriterCountsReadersOfOtherProcessesOnly) {
  DdsTransport a(test_parameters("a"));
  StringInbox own;
  const auto own_reader = a.make_reader("text", string_type(), msgs::event_qos(), own.handler());
  const auto writer = a.make_writer("text", string_type(), msgs::event_qos());
  EXPECT_FALSE(writer->has_readers());
  writer->write(make_string("to nobody"));

  std::optional<DdsTransport> b(test_parameters("b"));
  StringInbox inbox;
  auto reader = b->make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  writer->write(make_string("to b"));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.items(), std::vector<std::string>{"to b"});

  reader.reset();
  b.reset();
  EXPECT_TRUE(eventually([&] { return !writer->has_readers(); }));
  EXPECT_EQ(writer->counters().messages, 1U);
}

TEST_F(TwoProcesses, OwnMessagesAreNotReceived) {
  StringInbox at_a;
  StringInbox at_b;
  const auto a_reader = a_.make_reader("text", string_type(), msgs::event_qos(), at_a.handler());
  const auto b_reader = b_.make_reader("text", string_type(), msgs::event_qos(), at_b.handler());
  const auto a_writer = a_.make_writer("text", string_type(), msgs::event_qos());
  const auto b_writer = b_.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] {
    return a_writer->has_readers() && b_writer->has_readers() && a_reader->writers() == 1 &&
           b_reader->writers() == 1;
  }));
  a_writer->write(make_string("from a"));
  ASSERT_TRUE(at_b.wait_for(1));
  b_writer->write(make_string("from b"));
  ASSERT_TRUE(at_a.wait_for(1));
  EXPECT_TRUE(a_.flush(Duration::seconds(5)) && b_.flush(Duration::seconds(5)));
  EXPECT_EQ(at_a.items(), std::vector<std::string>{"from b"});
  EXPECT_EQ(at_b.items(), std::vector<std::string>{"from a"});
  EXPECT_EQ(a_reader->counters().dropped, 0U);
}

TEST(Transport, ALateJoinerGetsTheLatchedMessage) {
  DdsTransport a(test_parameters("a"));
  const auto writer = a.make_writer("latched", string_type(), msgs::latched_qos());
  writer->write(make_string("old"));
  writer->write(make_string("current"));
  ASSERT_TRUE(a.flush(Duration::seconds(5)));
  std::vector<std::unique_ptr<StringInbox>> inboxes;
  DdsTransport b(test_parameters("b"));
  std::vector<std::unique_ptr<graph::TransportReader>> readers;
  for (int i = 0; i < 30; ++i) {
    inboxes.push_back(std::make_unique<StringInbox>());
    readers.push_back(
        b.make_reader("latched", string_type(), msgs::latched_qos(), inboxes.back()->handler()));
  }
  for (const auto& inbox : inboxes) {
    ASSERT_TRUE(inbox->wait_for(1));
    EXPECT_EQ(inbox->items(), std::vector<std::string>{"current"});
  }
}

TEST_F(TwoProcesses, AFullQueueDropsAndCountsTheOldestMessage) {
  Inbox<std::uint32_t> inbox;
  const auto reader = b_.make_reader(
      "image", image_type(), msgs::sensor_stream_qos(), [&](const graph::MessagePtr& message) {
        inbox.put(static_cast<const Image*>(message.get())->height());
      });
  const auto writer = a_.make_writer("image", image_type(), msgs::sensor_stream_qos(2));
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  constexpr std::uint32_t kImages = 300;
  const auto pixels = make_image(3'000'000, 1);
  std::vector<graph::MessagePtr> images;
  for (std::uint32_t i = 1; i <= kImages; ++i) {
    // Two large images keep the sender busy while the others fill the queue.
    auto image = i <= 2 ? std::make_shared<Image>(*pixels) : std::make_shared<Image>();
    image->height(i);
    images.push_back(image);
  }
  for (const auto& image : images) {
    writer->write(image);
  }
  ASSERT_TRUE(a_.flush(Duration::seconds(5)));
  EXPECT_EQ(writer->counters().messages + writer->counters().dropped, kImages);
  EXPECT_GT(writer->counters().dropped, 0U);
  ASSERT_TRUE(eventually([&] { return inbox.size() > 0 && inbox.items().back() == kImages; }));
  const auto got = inbox.items();
  EXPECT_TRUE(std::is_sorted(got.begin(), got.end()));
}

TEST_F(TwoProcesses, AnotherTypeIsNotMatched) {
  StringInbox inbox;
  const auto text = b_.make_reader("topic", string_type(), msgs::event_qos(), inbox.handler());
  const auto image = a_.make_writer("topic", image_type(), msgs::event_qos());
  EXPECT_TRUE(eventually([&] {
    const auto topics = b_.discovery().topics;
    return std::any_of(topics.begin(), topics.end(), [](const TopicInfo& topic) {
      return topic.name == "topic" && topic.type_names.size() == 2;
    });
  }));
  EXPECT_FALSE(image->has_readers());
  EXPECT_EQ(text->writers(), 0);
}

TEST(Transport, OneProcessCannotHaveATopicWithTwoTypes) {
  DdsTransport a(test_parameters("a"));
  const auto writer = a.make_writer("topic", string_type(), msgs::event_qos());
  EXPECT_THROW((void)a.make_writer("topic", image_type(), msgs::event_qos()), ConfigError);
}

TEST(Transport, WaitingMessagesAreDeliveredBeforeAWriterIsDestroyed) {
  DdsTransport b(test_parameters("b"));
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  {
    DdsTransport a(test_parameters("a"));
    const auto writer = a.make_writer("text", string_type(), msgs::event_qos());
    ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
    for (int i = 0; i < 50; ++i) {
      writer->write(make_string(std::to_string(i)));
    }
  }
  EXPECT_TRUE(inbox.wait_for(50));
}

}  // namespace
}  // namespace furrow::dds
