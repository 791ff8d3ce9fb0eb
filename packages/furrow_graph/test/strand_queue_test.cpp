#include "../src/strand_queue.hpp"

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

/// Two nodes with two timers each.
class StrandQueueTest : public testing::Test {
 protected:
  StrandQueueTest() {
    type_.name = "idle";
    type_.make = [](Context&) { return std::make_unique<Component>(); };
    for (Node* node : {&a_, &b_}) {
      for (int i = 0; i < 2; ++i) node->every(Duration::milliseconds(1), [](Time) {});
      queue_.add(*node);
    }
  }

  NoHost host_;
  ComponentClass type_;
  Node a_{test::spec("a", "idle"), type_, {}, 1, host_};
  Node b_{test::spec("b", "idle"), type_, {}, 1, host_};
  StrandQueue queue_;
};

TEST_F(StrandQueueTest, ANodeWaitsOnceInTheOrderInWhichItCame) {
  queue_.enqueue(b_);
  queue_.enqueue(a_);
  queue_.enqueue(b_);
  ASSERT_EQ(queue_.size(), 2U);
  EXPECT_EQ(&queue_.front(), &b_);
  EXPECT_EQ(queue_.begin_first().node, &b_);
  EXPECT_EQ(queue_.begin_first().node, &a_);
  EXPECT_TRUE(queue_.empty());
}

TEST_F(StrandQueueTest, WhatComesDuringACallWaitsForItsEnd) {
  queue_.enqueue(a_);
  (void)queue_.begin_first();
  queue_.enqueue(a_);
  EXPECT_TRUE(queue_.empty());
  queue_.end(a_);
  ASSERT_EQ(queue_.size(), 1U);
  EXPECT_EQ(queue_.begin_first().node, &a_);
  queue_.end(a_);
  EXPECT_TRUE(queue_.empty());
}

TEST_F(StrandQueueTest, ATimerIsPendingUntilItsCallBegins) {
  const Time first = Time::from_seconds(1.0);
  const Time second = Time::from_seconds(2.0);
  EXPECT_TRUE(queue_.enqueue_timer(a_, 1, first));
  EXPECT_FALSE(queue_.enqueue_timer(a_, 1, second));
  EXPECT_TRUE(queue_.enqueue_timer(a_, 0, second));
  const StrandQueue::Call call = queue_.begin_first();
  ASSERT_EQ(call.timers.size(), 2U);
  EXPECT_EQ(call.timers[0].timer, 1U);
  EXPECT_EQ(call.timers[0].due, first);
  EXPECT_EQ(call.timers[1].timer, 0U);
  EXPECT_TRUE(queue_.enqueue_timer(a_, 1, second));
  queue_.end(a_);
  const StrandQueue::Call again = queue_.begin_first();
  ASSERT_EQ(again.timers.size(), 1U);
  EXPECT_EQ(again.timers[0].due, second);
}

TEST_F(StrandQueueTest, OnlyAnIdleNodeBeginsWithoutItsTurn) {
  EXPECT_TRUE(queue_.begin_or_enqueue(a_));
  EXPECT_FALSE(queue_.begin_or_enqueue(a_));
  queue_.end(a_);
  EXPECT_EQ(queue_.size(), 1U);
  EXPECT_FALSE(queue_.begin_or_enqueue(a_));
  EXPECT_EQ(queue_.size(), 1U);
  EXPECT_TRUE(queue_.begin_or_enqueue(b_));
}

}  // namespace
}  // namespace furrow::graph
