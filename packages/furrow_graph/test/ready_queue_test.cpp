#include "../src/ready_queue.hpp"

#include <future>

#include "../src/node.hpp"
#include "fixtures.hpp"

namespace furrow::graph {
namespace {

class NoHost final : public NodeHost {
 public:
  [[nodiscard]] Time now() const override { return {}; }
  void publish(Node&, Route&, MessagePtr) override {}
  void request_stop(std::string_view, bool) override {}
};

/// Three nodes with two timers each.
class ReadyQueueTest : public testing::Test {
 protected:
  ReadyQueueTest() {
    for (Node* node : {&a_, &b_, &c_}) {
      for (int i = 0; i < 2; ++i) node->every(Duration::milliseconds(1), [](Time) {});
      queue_.add(*node);
    }
  }
  Node* pop_node() { return queue_.pop().value().node; }

  NoHost host_;
  ComponentClass type_{.name = "idle"};
  Node a_{test::spec("a", "idle"), type_, {}, 1, host_};
  Node b_{test::spec("b", "idle"), type_, {}, 1, host_};
  Node c_{test::spec("c", "idle"), type_, {}, 1, host_};
  ReadyQueue queue_;
};

TEST_F(ReadyQueueTest, HoldsANodeOnceInTheOrderOfArrival) {
  queue_.push(b_);
  queue_.push(a_);
  queue_.push(b_);
  queue_.push(c_);
  EXPECT_EQ(pop_node(), &b_);
  EXPECT_EQ(pop_node(), &a_);
  EXPECT_EQ(pop_node(), &c_);
}

TEST_F(ReadyQueueTest, ANodeThatBecomesReadyDuringItsCallWaitsForTheEndOfTheCall) {
  queue_.push(a_);
  EXPECT_EQ(pop_node(), &a_);
  queue_.push(a_);
  queue_.push(b_);
  EXPECT_EQ(pop_node(), &b_);
  queue_.push(c_);
  queue_.done(a_);
  EXPECT_EQ(pop_node(), &c_);
  EXPECT_EQ(pop_node(), &a_);
}

TEST_F(ReadyQueueTest, ATickIsPendingUntilItsCallBegins) {
  const Time first = Time::from_seconds(1.0);
  const Time second = Time::from_seconds(2.0);
  EXPECT_TRUE(queue_.push_timer(a_, 1, first));
  EXPECT_FALSE(queue_.push_timer(a_, 1, second));
  EXPECT_TRUE(queue_.push_timer(a_, 0, second));
  const auto call = queue_.pop();
  ASSERT_EQ(call->timers.size(), 2U);
  EXPECT_EQ(call->timers[0].timer, 1U);
  EXPECT_EQ(call->timers[0].due, first);
  EXPECT_EQ(call->timers[1].timer, 0U);
  EXPECT_TRUE(queue_.push_timer(a_, 1, second));
  queue_.done(a_);
  const auto next = queue_.pop();
  ASSERT_EQ(next->timers.size(), 1U);
  EXPECT_EQ(next->timers[0].due, second);
}

TEST_F(ReadyQueueTest, WakesAWaitingWorkerForANodeAndForTheEnd) {
  auto worker = std::async(std::launch::async, [this] { return pop_node(); });
  queue_.push(a_);
  EXPECT_EQ(worker.get(), &a_);
  auto last = std::async(std::launch::async, [this] { return queue_.pop().has_value(); });
  queue_.close();
  EXPECT_FALSE(last.get());
  EXPECT_FALSE(queue_.pop());
}

}  // namespace
}  // namespace furrow::graph
