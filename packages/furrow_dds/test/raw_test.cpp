#include <gtest/gtest.h>

#include <algorithm>

#include "test_support.hpp"

namespace furrow::dds {
namespace {

// In CDR form.
std::vector<std::byte> cdr_of(const StringMessage& message) {
  std::vector<std::byte> bytes(string_type().serialized_size(&message));
  const auto size = string_type().serialize(&message, bytes);
  EXPECT_TRUE(size.ok());
  // RTPS pads payloads to four bytes (RTPS 2.5, 10.2.1.2).
  bytes.resize((*size + 3) / 4 * 4);
  return bytes;
}

TEST(Raw, ReadsTheCdrFormOfATypedWriter) {
  DdsTransport a(test_parameters("a"));
  DdsTransport b(test_parameters("b"));
  Inbox<RawMessage> inbox;
  const auto reader =
      b.make_raw_reader("text", std::string(string_type().dds_name), msgs::event_qos(),
                        [&](RawMessage message) { inbox.put(std::move(message)); });
  const auto writer = a.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  StringMessage message;
  message.data("as bytes");
  writer->write(std::make_shared<StringMessage>(message));
  ASSERT_TRUE(inbox.wait_for(1));
  const RawMessage raw = inbox.items().front();
  EXPECT_EQ(raw.payload, cdr_of(message));
  EXPECT_GT(raw.source_time, Time());
  EXPECT_GE(raw.reception_time, raw.source_time);
  const auto topics = b.discovery().topics;
  const auto topic = std::find_if(topics.begin(), topics.end(),
                                  [](const TopicInfo& info) { return info.name == "text"; });
  ASSERT_NE(topic, topics.end());
  ASSERT_EQ(topic->writers.size(), 1U);
  EXPECT_EQ(topic->writers.front().guid, raw.writer);
}

TEST(Raw, WritesForATypedReader) {
  DdsTransport a(test_parameters("a"));
  DdsTransport b(test_parameters("b"));
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  const auto writer =
      a.make_raw_writer("text", std::string(string_type().dds_name), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  StringMessage message;
  message.data("from bytes");
  writer->write(std::make_shared<const std::vector<std::byte>>(cdr_of(message)));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.items(), std::vector<std::string>{"from bytes"});
}

TEST(Raw, CarriesTypesUnknownAtCompileTime) {
  DdsTransport a(test_parameters("a"));
  DdsTransport b(test_parameters("b"));
  Inbox<RawMessage> inbox;
  const std::string type = "someones::msg::dds_::Thing_";
  const auto reader = b.make_raw_reader("//thing", type, msgs::event_qos(),
                                        [&](RawMessage message) { inbox.put(std::move(message)); });
  const auto writer = a.make_raw_writer("//thing", type, msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  std::vector<std::byte> bytes(1'000'000, std::byte{7});
  bytes[0] = std::byte{0};
  bytes[1] = std::byte{1};
  writer->write(std::make_shared<const std::vector<std::byte>>(bytes));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.items().front().payload, bytes);
}

TEST(Raw, MalformedMessagesAreCountedAndDropped) {
  DdsTransport a(test_parameters("a"));
  DdsTransport b(test_parameters("b"));
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  const auto writer =
      a.make_raw_writer("text", std::string(string_type().dds_name), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  StringMessage message;
  message.data("a text that is cut short");
  const auto whole = cdr_of(message);
  for (std::size_t size = 4; size < whole.size() - 4; size += 3) {
    writer->write(std::make_shared<const std::vector<std::byte>>(
        whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
  }
  writer->write(std::make_shared<const std::vector<std::byte>>(whole));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.items().front(), message.data());
  ASSERT_TRUE(a.flush(Duration::seconds(5)));
  EXPECT_EQ(reader->counters().dropped, writer->counters().messages - 1);
  EXPECT_GT(reader->counters().dropped, 0U);
}

TEST(Raw, PayloadsWithoutEncapsulationAreRefused) {
  DdsTransport a(test_parameters("a"));
  const auto writer =
      a.make_raw_writer("text", std::string(string_type().dds_name), msgs::latched_qos());
  writer->write(nullptr);
  writer->write(std::make_shared<const std::vector<std::byte>>(3));
  ASSERT_TRUE(a.flush(Duration::seconds(5)));
  EXPECT_EQ(writer->counters().dropped, 2U);
  EXPECT_EQ(writer->counters().messages, 0U);
}

TEST(Raw, WritesOnTheCallingThread) {
  DdsTransport a(test_parameters("a"));
  DdsTransport b(test_parameters("b"));
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  const auto writer =
      a.make_raw_writer("text", std::string(string_type().dds_name), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  StringMessage message;
  message.data("at once");
  EXPECT_TRUE(writer->write_now(cdr_of(message)));
  EXPECT_FALSE(writer->write_now(std::vector<std::byte>(3)));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.items(), std::vector<std::string>{"at once"});
}

TEST(Raw, TypedAndRawEndpointsShareATopic) {
  DdsTransport a(test_parameters("a"));
  DdsTransport b(test_parameters("b"));
  StringInbox typed;
  Inbox<RawMessage> raw;
  const auto typed_reader =
      b.make_reader("text", string_type(), msgs::event_qos(), typed.handler());
  const auto raw_reader =
      b.make_raw_reader("text", std::string(string_type().dds_name), msgs::event_qos(),
                        [&](RawMessage message) { raw.put(std::move(message)); });
  const auto writer = a.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] {
    return writer->has_readers() && typed_reader->writers() == 1 && raw_reader->writers() == 1;
  }));
  writer->write(make_string("both"));
  EXPECT_TRUE(typed.wait_for(1));
  EXPECT_TRUE(raw.wait_for(1));
}

}  // namespace
}  // namespace furrow::dds
