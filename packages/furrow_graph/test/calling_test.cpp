// Which thread calls a component for what comes from outside, in real time.

#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <thread>

#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"

namespace furrow::graph {
namespace {

using furrow_msgs::msg::Plan;
using test::spec;

/// The test itself is the thread that receives.
class ManualTransport final : public Transport {
 public:
  std::unique_ptr<TransportWriter> make_writer(const std::string&, const msgs::MessageType&,
                                               const msgs::Qos&) override {
    return std::make_unique<Writer>();
  }
  std::unique_ptr<TransportReader> make_reader(
      const std::string& topic, const msgs::MessageType&, const msgs::Qos&,
      std::function<void(MessagePtr)> on_message) override {
    readers_[topic] = std::move(on_message);
    return std::make_unique<Reader>();
  }
  void deliver(std::uint64_t revision) {
    auto plan = std::make_shared<Plan>();
    plan->revision(revision);
    readers_.at("planner/plan")(std::move(plan));
  }

 private:
  struct Writer final : TransportWriter {
    [[nodiscard]] bool has_readers() const override { return false; }
    void write(MessagePtr) override {}
    [[nodiscard]] TransportCounters counters() const override { return {}; }
  };
  struct Reader final : TransportReader {
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    [[nodiscard]] int writers() const override { return 0; }
  };
  std::map<std::string, std::function<void(MessagePtr)>> readers_;
};

/// A process with nothing but a sink, whose plans come from outside.
class CallingTest : public testing::Test {
 protected:
  void start(std::function<void(const Plan&)> take) {
    test::add_sink(registry_, [this, take = std::move(take)](Context&, const Plan& plan) {
      EXPECT_FALSE(inside_.exchange(true)) << "called twice at once";
      take(plan);
      inside_ = false;
      ++calls_;
    });
    GraphSpec graph;
    graph.components = {spec("s", "source"), spec("r", "relay"), spec("sink", "sink")};
    runtime_ = std::make_unique<Runtime>(graph, registry_,
                                         RuntimeOptions{.clock = ClockMode::kReal,
                                                        .threads = 2,
                                                        .components = {"sink"},
                                                        .transport = &transport_});
    ended_ = std::async(std::launch::async, [this] { runtime_->run(); });
  }
  /// Returns when the plan has been read.
  void deliver_and_wait(std::uint64_t revision) {
    transport_.deliver(revision);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (calls_ < revision && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    ASSERT_GE(calls_, revision);
  }
  void TearDown() override {
    runtime_->request_stop("enough");
    ended_.wait();
  }

  ManualTransport transport_;
  Registry registry_ = test::standard_registry();
  std::atomic<bool> inside_ = false;
  std::atomic<std::uint64_t> calls_ = 0;
  std::unique_ptr<Runtime> runtime_;
  std::future<void> ended_;
};

TEST_F(CallingTest, AShortCallComesOnTheThreadThatReceived) {
  std::atomic<int> here = 0;
  start([&, receiver = std::this_thread::get_id()](const Plan&) {
    if (std::this_thread::get_id() == receiver) ++here;
  });
  deliver_and_wait(1);
  EXPECT_EQ(here, 0) << "it was not known how long it takes";
  // On a machine that is busy a call may seem long for a while.
  constexpr std::uint64_t kPatience = 20000;
  for (std::uint64_t i = 2; i < kPatience && here < 100; ++i) deliver_and_wait(i);
  EXPECT_GE(here, 100);
}

TEST_F(CallingTest, ALongCallHoldsNobodyUpWhoReceives) {
  std::atomic<int> here = 0;
  start([&, receiver = std::this_thread::get_id()](const Plan&) {
    if (std::this_thread::get_id() == receiver) ++here;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  for (std::uint64_t i = 1; i <= 20; ++i) deliver_and_wait(i);
  EXPECT_EQ(here, 0);
}

TEST_F(CallingTest, TheRunEndsAfterTheLastCall) {
  std::promise<void> begun;
  std::promise<void> let_go;
  std::atomic<bool> returned = false;
  std::atomic<bool> hold = false;
  start([&, receiver = std::this_thread::get_id()](const Plan&) {
    if (!hold || std::this_thread::get_id() == receiver) return;
    begun.set_value();
    let_go.get_future().wait();
    returned = true;
  });
  constexpr std::uint64_t kUntilShort = 2000;
  for (std::uint64_t i = 1; i <= kUntilShort; ++i) deliver_and_wait(i);
  hold = true;
  std::thread receiver([&] { transport_.deliver(kUntilShort + 1); });
  begun.get_future().wait();
  runtime_->request_stop("enough");
  EXPECT_EQ(ended_.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  let_go.set_value();
  ended_.wait();
  EXPECT_TRUE(returned);
  receiver.join();
}

}  // namespace
}  // namespace furrow::graph
