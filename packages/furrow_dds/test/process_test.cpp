#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "test_support.hpp"

extern char** environ;

namespace furrow::dds {
namespace {

/// Runs the peer program; kills it at the end.
class PeerProcess {
 public:
  PeerProcess() {
    std::string program = FURROW_DDS_TEST_PEER;
    std::string domain = std::to_string(test_domain());
    char* arguments[] = {program.data(), domain.data(), nullptr};
    started_ = posix_spawn(&pid_, program.c_str(), nullptr, nullptr, arguments, environ) == 0;
  }
  ~PeerProcess() { end(); }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;
  [[nodiscard]] bool started() const { return started_; }
  void signal(int number) const { kill(pid_, number); }
  void end() {
    if (started_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
      started_ = false;
    }
  }

 private:
  pid_t pid_ = 0;
  bool started_ = false;
};

class Watched : public ::testing::Test {
 protected:
  void SetUp() override {
    transport_.on_fault([this](const TransportFault& fault) { faults_.put(fault.kind); });
    reader_ = transport_.make_reader("alive", string_type(), watched_qos(), inbox_.handler());
    peer_.emplace();
    ASSERT_TRUE(peer_->started());
    ASSERT_TRUE(inbox_.wait_for(3));
  }
  void TearDown() override { transport_.on_fault({}); }
  [[nodiscard]] bool reported(TransportFaultKind kind) {
    return eventually([&] {
      const auto kinds = faults_.items();
      return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    });
  }

  DdsTransport transport_{test_parameters("watcher")};
  Inbox<TransportFaultKind> faults_;
  StringInbox inbox_;
  std::unique_ptr<graph::TransportReader> reader_;
  std::optional<PeerProcess> peer_;
};

TEST_F(Watched, TheLivelinessLeaseNoticesAKilledProcessBeforeDiscoveryDoes) {
  peer_->end();
  ASSERT_TRUE(reported(TransportFaultKind::kLivelinessLost));
  // Discovery forgets the process after the participant's lease, 15 times as long.
  EXPECT_EQ(transport_.discovery().processes.size(), 2U);
  EXPECT_EQ(transport_.status().front().liveliness_losses, 1U);
}

TEST_F(Watched, ReportsAStoppedProcessAndItsReturn) {
  peer_->signal(SIGSTOP);
  ASSERT_TRUE(reported(TransportFaultKind::kLivelinessLost));
  peer_->signal(SIGCONT);
  EXPECT_TRUE(reported(TransportFaultKind::kLivelinessRegained));
  const std::size_t before = inbox_.size();
  EXPECT_TRUE(inbox_.wait_for(before + 3));
}

}  // namespace
}  // namespace furrow::dds
