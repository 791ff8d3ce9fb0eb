// Who sees to it that what is published in real time leaves the process.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"

namespace furrow::graph {
namespace {

using furrow_msgs::msg::Plan;
using test::spec;

/// Has an outside reader for plans. What is enqueued leaves only when the graph says so.
class HoldingTransport final : public Transport {
 public:
  std::unique_ptr<TransportWriter> make_writer(const std::string& topic, const msgs::MessageType&,
                                               const msgs::Qos&) override {
    return std::make_unique<Writer>(*this, topic == "planner/plan");
  }
  std::unique_ptr<TransportReader> make_reader(const std::string&, const msgs::MessageType&,
                                               const msgs::Qos&,
                                               std::function<void(MessagePtr)>) override {
    return std::make_unique<Reader>();
  }
  [[nodiscard]] bool has_waiting() const override {
    const std::lock_guard lock(mutex_);
    return !waiting_.empty();
  }
  void send_one() override {
    const std::lock_guard lock(mutex_);
    if (!waiting_.empty()) send_first();
  }
  void wake_senders() override {
    const std::lock_guard lock(mutex_);
    while (!waiting_.empty()) send_first();
  }

  [[nodiscard]] bool wait_sent(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(5), [&] { return sent_.size() >= count; });
  }
  [[nodiscard]] std::vector<std::uint64_t> sent() const {
    const std::lock_guard lock(mutex_);
    return sent_;
  }
  [[nodiscard]] int written() const {
    const std::lock_guard lock(mutex_);
    return written_;
  }

 private:
  struct Writer final : TransportWriter {
    Writer(HoldingTransport& holding, bool is_read) : owner(holding), read(is_read) {}
    [[nodiscard]] bool has_readers() const override { return read; }
    void write(MessagePtr) override {
      const std::lock_guard lock(owner.mutex_);
      ++owner.written_;
    }
    void enqueue(MessagePtr message) override {
      const std::lock_guard lock(owner.mutex_);
      owner.waiting_.push_back(std::move(message));
    }
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    HoldingTransport& owner;
    const bool read;
  };
  struct Reader final : TransportReader {
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    [[nodiscard]] int writers() const override { return 0; }
  };

  // With the mutex held.
  void send_first() {
    sent_.push_back(static_cast<const Plan*>(waiting_.front().get())->revision());
    waiting_.erase(waiting_.begin());
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<MessagePtr> waiting_;
  std::vector<std::uint64_t> sent_;
  int written_ = 0;
};

GraphSpec fast_chain(bool with_sink) {
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay")};
  graph.components[0].parameters = {{"rate_hz", 1000.0, {}}};
  if (with_sink) graph.components.push_back(spec("sink", "sink"));
  return graph;
}

constexpr std::uint64_t kPlans = 30;

TEST(Sending, AReaderInsideThatTakesLongHoldsNoMessageBack) {
  for (const int threads : {1, 2, 4}) {
    HoldingTransport transport;
    Registry registry = test::standard_registry();
    bool all_left = true;
    test::add_sink(registry, [&](Context& context, const Plan& plan) {
      // Does not return before the message that it reads has left.
      all_left = all_left && transport.wait_sent(plan.revision());
      if (!all_left || plan.revision() == kPlans) context.request_stop("enough");
    });
    Runtime runtime(fast_chain(true), registry,
                    {.clock = ClockMode::kReal, .threads = threads, .transport = &transport});
    runtime.run();
    EXPECT_TRUE(all_left) << threads;
    EXPECT_TRUE(std::ranges::is_sorted(transport.sent())) << threads;
  }
}

TEST(Sending, WhatNobodyInsideReadsLeavesWhenTheCallbackHasReturned) {
  for (const int threads : {1, 2, 4}) {
    HoldingTransport transport;
    Registry registry = test::standard_registry();
    Runtime runtime(fast_chain(false), registry,
                    {.clock = ClockMode::kReal, .threads = threads, .transport = &transport});
    std::thread stopper([&] {
      EXPECT_TRUE(transport.wait_sent(kPlans)) << threads;
      runtime.request_stop("enough");
    });
    runtime.run();
    stopper.join();
    EXPECT_EQ(transport.written(), 0) << threads;
  }
}

TEST(Sending, MessagesThatWaitedTogetherLeaveOneByOne) {
  HoldingTransport transport;
  Registry registry;
  ComponentClass burst{.name = "source"};
  burst.description.output<msgs::topics::Tracks>();
  burst.make = [](Context& context) {
    auto out = context.output<msgs::topics::Tracks>();
    context.every(Duration::milliseconds(1), [out](Time) {
      for (int i = 0; i < 3; ++i) out.publish(furrow_msgs::msg::Tracks());
    });
    return std::make_unique<Component>();
  };
  registry.add(std::move(burst));
  ComponentClass relay{.name = "relay"};
  relay.description.input<msgs::topics::Tracks>().output<msgs::topics::Plan>();
  std::uint64_t count = 0;
  bool all_left = true;
  relay.make = [&](Context& context) {
    auto out = context.output<msgs::topics::Plan>();
    context.input<msgs::topics::Tracks>(
        [&, out](const std::shared_ptr<const furrow_msgs::msg::Tracks>&) {
          // Does not return before what it published last has left.
          all_left = all_left && transport.wait_sent(count);
          if (!all_left || count == kPlans) return context.request_stop("enough");
          Plan plan;
          plan.revision(++count);
          out.publish(std::move(plan));
        });
    return std::make_unique<Component>();
  };
  registry.add(std::move(relay));
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay")};
  Runtime runtime(graph, registry,
                  {.clock = ClockMode::kReal, .threads = 1, .transport = &transport});
  runtime.run();
  EXPECT_TRUE(all_left);
}

TEST(Sending, AThreadOfItsOwnLeavesItToTheTransport) {
  HoldingTransport transport;
  Registry registry = test::standard_registry();
  test::add_sink(registry, [&](Context& context, const Plan& plan) {
    if (plan.revision() == kPlans) context.request_stop("enough");
  });
  GraphSpec graph = fast_chain(true);
  graph.components[1].dedicated_thread = true;
  Runtime runtime(graph, registry,
                  {.clock = ClockMode::kReal, .threads = 2, .transport = &transport});
  runtime.run();
  EXPECT_GE(transport.written(), static_cast<int>(kPlans));
  EXPECT_TRUE(transport.sent().empty());
}

}  // namespace
}  // namespace furrow::graph
