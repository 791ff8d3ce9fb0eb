// The real-time executor between the threads of a transport: which thread calls a component, and
// when a message reaches the transport.

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "fake_transport.hpp"
#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"

namespace furrow::graph {
namespace {

using furrow_msgs::msg::Plan;
using furrow_msgs::msg::Tracks;
using test::spec;
constexpr std::chrono::seconds kPatience{5};

/// A process with a sink and a relay, whose plans and tracks come from outside.
class ReceivingTest : public testing::Test {
 protected:
  void start(std::function<void(const Plan&)> take) {
    test::add_sink(registry_, [this, take = std::move(take)](Context&, const Plan& plan) {
      take(plan);
      ++calls_;
    });
    GraphSpec graph;
    graph.components = {spec("s", "source"), spec("r", "relay"), spec("remote", "relay"),
                        spec("sink", "sink")};
    // The relay of this process publishes a topic of its own.
    graph.components[1].remaps = {{"planner/plan", "relayed"}};
    runtime_ = std::make_unique<Runtime>(graph, registry_,
                                         RuntimeOptions{.clock = ClockMode::kReal,
                                                        .threads = 2,
                                                        .components = {"r", "sink"},
                                                        .transport = &transport_});
    ended_ = std::async(std::launch::async, [this] { runtime_->run(); });
  }
  void deliver_plan(std::uint64_t revision) {
    auto plan = std::make_shared<Plan>();
    plan->revision(revision);
    transport_.receivers.at("planner/plan")(std::move(plan));
  }
  void deliver_and_wait(std::uint64_t revision) {
    deliver_plan(revision);
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (calls_ < revision && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    ASSERT_GE(calls_, revision);
  }
  void TearDown() override {
    runtime_->request_stop("enough");
    ended_.wait();
  }

  test::FakeTransport transport_;
  Registry registry_ = test::standard_registry();
  std::atomic<std::uint64_t> calls_ = 0;
  std::unique_ptr<Runtime> runtime_;
  std::future<void> ended_;
};

constexpr std::uint64_t kShortCalls = 2000;

TEST_F(ReceivingTest, TheReceiveThreadRunsNoCallback) {
  std::atomic<int> here = 0;
  start([&, receiver = std::this_thread::get_id()](const Plan&) {
    if (std::this_thread::get_id() == receiver) ++here;
  });
  for (std::uint64_t i = 1; i <= kShortCalls; ++i) deliver_and_wait(i);
  EXPECT_EQ(here, 0);
}

TEST_F(ReceivingTest, ALongCallbackAfterManyShortOnesDoesNotHoldUpTheReceiveThread) {
  std::promise<void> release;
  std::atomic<bool> released = false;
  start([&, released_later = release.get_future().share()](const Plan& plan) {
    if (plan.revision() <= kShortCalls) return;
    released = released_later.wait_for(kPatience) == std::future_status::ready;
  });
  for (std::uint64_t i = 1; i <= kShortCalls; ++i) deliver_and_wait(i);
  deliver_plan(kShortCalls + 1);
  transport_.receivers.at("tracker/tracks")(std::make_shared<Tracks>());
  EXPECT_TRUE(transport_.wait_written("relayed", 1)) << "the other component was not called";
  EXPECT_EQ(calls_, kShortCalls) << "the long callback returned before it was released";
  release.set_value();
  runtime_->request_stop("enough");
  ended_.wait();
  EXPECT_TRUE(released);
}

TEST_F(ReceivingTest, TheRunEndsAfterTheLastCallback) {
  std::promise<void> begun;
  std::promise<void> release;
  std::atomic<bool> returned = false;
  start([&](const Plan&) {
    begun.set_value();
    release.get_future().wait();
    returned = true;
  });
  deliver_plan(1);
  begun.get_future().wait();
  runtime_->request_stop("enough");
  release.set_value();
  ended_.wait();
  EXPECT_TRUE(returned);
}

TEST(Sending, EveryTopicOfACallbackReachesTheTransportAtItsPublication) {
  test::FakeTransport transport;
  Registry registry;
  std::size_t plans = 0;
  std::size_t tracks = 0;
  ComponentClass pair{.name = "pair"};
  pair.description.output<msgs::topics::Plan>().output<msgs::topics::Tracks>();
  pair.make = [&](Context& context) {
    auto plan = context.output<msgs::topics::Plan>();
    auto track = context.output<msgs::topics::Tracks>();
    context.every(Duration::milliseconds(1), [&, plan, track](Time) {
      plan.publish(Plan());
      plans = transport.written("planner/plan").size();
      track.publish(Tracks());
      tracks = transport.written("tracker/tracks").size();
      context.request_stop("enough");
    });
    return std::make_unique<Component>();
  };
  registry.add(std::move(pair));
  GraphSpec graph;
  graph.components = {spec("p", "pair")};
  Runtime(graph, registry, {.clock = ClockMode::kReal, .transport = &transport}).run();
  EXPECT_EQ(plans, 1U);
  EXPECT_EQ(tracks, 1U);
}

TEST(Sending, ABusyReaderInTheProcessHoldsNoMessageBack) {
  constexpr std::uint64_t kPlans = 30;
  for (const int threads : {1, 2, 4}) {
    test::FakeTransport transport;
    Registry registry = test::standard_registry();
    bool all_left = true;
    test::add_sink(registry, [&](Context& context, const Plan& plan) {
      // Does not return before the transport has the message that it reads.
      all_left = all_left && transport.wait_written("planner/plan", plan.revision());
      if (!all_left || plan.revision() == kPlans) context.request_stop("enough");
    });
    GraphSpec graph;
    graph.components = {spec("s", "source"), spec("r", "relay"), spec("sink", "sink")};
    graph.components[0].parameters = {{"rate_hz", 1000.0, {}}};
    Runtime(graph, registry,
            {.clock = ClockMode::kReal, .threads = threads, .transport = &transport})
        .run();
    EXPECT_TRUE(all_left) << threads;
  }
}

}  // namespace
}  // namespace furrow::graph
