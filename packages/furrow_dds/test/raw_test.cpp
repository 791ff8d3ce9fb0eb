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

RawPayload payload_of(const StringMessage& message) {
  return std::make_shared<const std::vector<std::byte>>(cdr_of(message));
}

/// A raw writer and a typed reader of one topic, matched.
class RawToTyped : public TwoProcesses {
 protected:
  void SetUp() override {
    reader_ = b_.make_reader("text", string_type(), msgs::event_qos(), inbox_.handler());
    writer_ = a_.make_raw_writer("text", std::string(string_type().dds_name), msgs::event_qos());
    ASSERT_TRUE(eventually([&] { return writer_->has_readers() && reader_->writers() == 1; }));
    message_.data("from bytes");
  }

  StringInbox inbox_;
  std::unique_ptr<graph::TransportReader> reader_;
  std::unique_ptr<RawWriter> writer_;
  StringMessage message_;
};

TEST_F(TwoProcesses, ReadsTheCdrFormOfATypedWriter) {
  Inbox<RawMessage> inbox;
  const auto reader =
      b_.make_raw_reader("text", std::string(string_type().dds_name), msgs::event_qos(),
                         [&](RawMessage message) { inbox.put(std::move(message)); });
  const auto writer = a_.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  StringMessage message;
  message.data("as bytes");
  writer->write(std::make_shared<StringMessage>(message));
  ASSERT_TRUE(inbox.wait_for(1));
  const RawMessage raw = inbox.items().front();
  EXPECT_EQ(raw.payload, cdr_of(message));
  EXPECT_GT(raw.source_time, Time());
  EXPECT_GE(raw.reception_time, raw.source_time);
  const auto topics = b_.discovery().topics;
  const auto topic = std::ranges::find(topics, "text", &TopicInfo::name);
  ASSERT_NE(topic, topics.end());
  ASSERT_EQ(topic->writers.size(), 1U);
  EXPECT_EQ(topic->writers.front().guid, raw.writer);
}

TEST_F(RawToTyped, SendsFromAQueue) {
  writer_->write(payload_of(message_));
  ASSERT_TRUE(inbox_.wait_for(1));
  EXPECT_EQ(inbox_.items().front(), message_.data());
}

TEST_F(RawToTyped, SendsOnTheCallingThread) {
  EXPECT_TRUE(writer_->write_now(cdr_of(message_)));
  EXPECT_FALSE(writer_->write_now(std::vector<std::byte>(3)));
  ASSERT_TRUE(inbox_.wait_for(1));
  EXPECT_EQ(inbox_.items().front(), message_.data());
}

TEST_F(RawToTyped, CountsAndDropsMalformedMessages) {
  const auto whole = cdr_of(message_);
  for (std::size_t size = 4; size < whole.size() - 4; size += 3) {
    writer_->write(std::make_shared<const std::vector<std::byte>>(
        whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
  }
  writer_->write(payload_of(message_));
  ASSERT_TRUE(inbox_.wait_for(1));
  EXPECT_EQ(inbox_.items().front(), message_.data());
  ASSERT_TRUE(a_.flush(Duration::seconds(5)));
  EXPECT_EQ(reader_->counters().dropped, writer_->counters().messages - 1);
  EXPECT_GT(reader_->counters().dropped, 0U);
}

TEST_F(TwoProcesses, CarriesTypesUnknownAtCompileTime) {
  Inbox<RawMessage> inbox;
  const std::string type = "someones::msg::dds_::Thing_";
  const auto reader =
      b_.make_raw_reader("//thing", type, msgs::event_qos(),
                         [&](RawMessage message) { inbox.put(std::move(message)); });
  const auto writer = a_.make_raw_writer("//thing", type, msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  std::vector<std::byte> bytes(1'000'000, std::byte{7});
  bytes[0] = std::byte{0};
  bytes[1] = std::byte{1};
  writer->write(std::make_shared<const std::vector<std::byte>>(bytes));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.items().front().payload, bytes);
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

TEST_F(TwoProcesses, TypedAndRawEndpointsShareATopic) {
  StringInbox typed;
  Inbox<RawMessage> raw;
  const auto typed_reader =
      b_.make_reader("text", string_type(), msgs::event_qos(), typed.handler());
  const auto raw_reader =
      b_.make_raw_reader("text", std::string(string_type().dds_name), msgs::event_qos(),
                         [&](RawMessage message) { raw.put(std::move(message)); });
  const auto writer = a_.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] {
    return writer->has_readers() && typed_reader->writers() == 1 && raw_reader->writers() == 1;
  }));
  writer->write(make_string("both"));
  EXPECT_TRUE(typed.wait_for(1));
  EXPECT_TRUE(raw.wait_for(1));
}

}  // namespace
}  // namespace furrow::dds
