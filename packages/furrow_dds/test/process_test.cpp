#include <optional>

#include "peer_process.hpp"
#include "test_support.hpp"

namespace furrow::dds {
namespace {

class Watched : public ::testing::Test {
 protected:
  void SetUp() override {
    reader_ = transport_.make_reader("alive", string_type(), watched_qos(), inbox_.handler());
    peer_.emplace(FURROW_DDS_TEST_PEER);
    ASSERT_TRUE(inbox_.wait_for(3));
  }
  [[nodiscard]] bool loses_the_peer() {
    return eventually([this] { return transport_.status().front().liveliness_losses == 1; });
  }

  DdsTransport transport_{test_parameters("watcher")};
  StringInbox inbox_;
  std::unique_ptr<graph::TransportReader> reader_;
  std::optional<PeerProcess> peer_;
};

TEST_F(Watched, TheLivelinessLeaseNoticesAKilledProcessBeforeDiscoveryDoes) {
  peer_->end();
  ASSERT_TRUE(loses_the_peer());
  // Discovery forgets the process after the participant's lease, 15 times as long.
  EXPECT_EQ(transport_.discovery().processes.size(), 2U);
}

TEST_F(Watched, ReportsAStoppedProcessAndItsReturn) {
  peer_->signal(SIGSTOP);
  ASSERT_TRUE(loses_the_peer());
  peer_->signal(SIGCONT);
  const std::size_t before = inbox_.size();
  EXPECT_TRUE(inbox_.wait_for(before + 3));
}

}  // namespace
}  // namespace furrow::dds
