#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <random>

#include "test_support.hpp"

namespace furrow::dds {
namespace {

/// Sends datagrams to the ports of a domain's first participants on loopback.
class Vandal {
 public:
  Vandal() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~Vandal() { close(socket_); }
  Vandal(const Vandal&) = delete;
  Vandal& operator=(const Vandal&) = delete;
  void send(const std::vector<std::uint8_t>& bytes) const {
    // RTPS 2.2, 9.6.1.3: 7400 + 250 domain, + 10 + 2 participant for discovery, + 11 for data.
    for (const int offset : {10, 11, 12, 13}) {
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * test_domain() + offset));
      (void)sendto(socket_, bytes.data(), bytes.size(), 0,
                   reinterpret_cast<const sockaddr*>(&address), sizeof(address));
    }
  }

 private:
  int socket_;
};

TEST(Faults, IgnoresGarbageOnTheRtpsPorts) {
  DdsTransport a(test_parameters("a", {"udp"}));
  DdsTransport b(test_parameters("b", {"udp"}));
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  const auto writer = a.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  const Vandal vandal;
  std::mt19937 random(1);
  const std::array<std::uint8_t, 8> header = {'R', 'T', 'P', 'S', 2, 3, 1, 15};
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> bytes(random() % 400);
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(random());
    }
    // Half of them start like RTPS: header and prefix, then a truncated or random submessage.
    if (i % 2 == 0 && bytes.size() > 24) {
      std::copy(header.begin(), header.end(), bytes.begin());
      constexpr std::array<std::uint8_t, 6> kKinds = {0x07, 0x06, 0x08, 0x09, 0x0e, 0x12};
      bytes[20] = kKinds[random() % kKinds.size()];
    }
    vandal.send(bytes);
  }
  for (int i = 0; i < 20; ++i) {
    writer->write(make_string("still here"));
  }
  EXPECT_TRUE(inbox.wait_for(20));
  EXPECT_EQ(inbox.items().back(), "still here");
}

TEST_F(TwoProcesses, ABlockedReaderDelaysNoOtherTopic) {
  DdsTransport c(test_parameters("c"));
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  StringInbox inbox;
  const auto stuck = b_.make_reader("image", image_type(), msgs::reliable_stream_qos(),
                                    [&](const graph::MessagePtr&) { released.wait(); });
  const auto healthy = c.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  const auto images = a_.make_writer("image", image_type(), msgs::reliable_stream_qos());
  const auto text = a_.make_writer("text", string_type(), msgs::event_qos());
  ASSERT_TRUE(eventually([&] { return images->has_readers() && text->has_readers(); }));
  const auto image = make_image(1'000'000, 1);
  for (int i = 0; i < 200; ++i) {
    images->write(image);
    text->write(make_string(std::to_string(i)));
  }
  EXPECT_GT(images->counters().dropped, 0U) << "write() waited for the reader";
  EXPECT_TRUE(inbox.wait_for(200));
  EXPECT_TRUE(
      eventually([&] { return images->counters().messages + images->counters().dropped == 200; }));
  release.set_value();
}

TEST_F(TwoProcesses, MissedDeadlinesAreCounted) {
  msgs::Qos qos = msgs::event_qos();
  qos.deadline = Duration::milliseconds(50);
  StringInbox inbox;
  const auto reader = b_.make_reader("text", string_type(), qos, inbox.handler());
  const auto writer = a_.make_writer("text", string_type(), qos);
  ASSERT_TRUE(eventually([&] { return writer->has_readers() && reader->writers() == 1; }));
  writer->write(make_string("once"));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_TRUE(eventually([&] { return b_.status().front().deadlines_missed >= 1; }));
}

TEST_F(TwoProcesses, IncompatibleQosIsReportedOnBothSides) {
  StringInbox inbox;
  const auto reader = b_.make_reader("text", string_type(), msgs::latched_qos(), inbox.handler());
  const auto writer = a_.make_writer("text", string_type(), msgs::reliable_stream_qos());
  const std::string policy = "durability: offered volatile, requested transient local";
  EXPECT_TRUE(eventually([&] { return a_.status().front().incompatible == 1; }));
  EXPECT_EQ(a_.status().front().incompatibility, policy + " (process 'b')");
  EXPECT_TRUE(eventually([&] { return b_.status().front().incompatible == 1; }));
  EXPECT_EQ(b_.status().front().incompatibility, policy + " (process 'a')");
  EXPECT_FALSE(writer->has_readers());
}

TEST_F(TwoProcesses, ADestroyedReaderIsNotCalled) {
  const auto writer = a_.make_writer("text", string_type(), msgs::event_qos());
  std::atomic<bool> stop{false};
  std::thread publisher([&] {
    while (!stop) {
      writer->write(make_string("again"));
      std::this_thread::yield();
    }
  });
  for (int i = 0; i < 20; ++i) {
    auto gone = std::make_shared<std::atomic<bool>>(false);
    auto calls = std::make_shared<std::atomic<int>>(0);
    auto reader = b_.make_reader("text", string_type(), msgs::event_qos(),
                                 [gone, calls](const graph::MessagePtr&) {
                                   EXPECT_FALSE(gone->load());
                                   ++*calls;
                                 });
    EXPECT_TRUE(eventually([&] { return calls->load() > 3; }));
    reader.reset();
    gone->store(true);
  }
  stop = true;
  publisher.join();
}

TEST(Faults, AProcessMayJoinAndLeaveOften) {
  DdsTransport peer(test_parameters("peer"));
  StringInbox inbox;
  const auto peer_reader =
      peer.make_reader("text", string_type(), msgs::event_qos(), inbox.handler());
  for (std::size_t i = 0; i < 10; ++i) {
    std::optional<DdsTransport> transport(test_parameters("guest"));
    auto writer = transport->make_writer("text", string_type(), msgs::event_qos());
    auto reader = transport->make_reader("image", image_type(), msgs::reliable_stream_qos(),
                                         [](const graph::MessagePtr&) {});
    ASSERT_TRUE(eventually([&] { return writer->has_readers(); }));
    writer->write(make_string("hello"));
    EXPECT_TRUE(inbox.wait_for(i + 1));
  }
}

}  // namespace
}  // namespace furrow::dds
