#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"

namespace furrow::graph {
namespace {

using furrow_msgs::msg::Plan;
using test::spec;

/// Waits for another thread to fulfil the condition. False after a long time.
template <class Condition>
bool happens(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

/// Registers a class with a timer of 1 ms.
void add_ticker(Registry& registry, std::function<void(Context&, Time)> tick) {
  ComponentClass ticker{.name = "ticker"};
  ticker.make = [tick = std::move(tick)](Context& context) {
    context.every(Duration::milliseconds(1), [&context, tick](Time due) { tick(context, due); });
    return std::make_unique<Component>();
  };
  registry.add(std::move(ticker));
}

ComponentSpec dedicated(ComponentSpec component, int priority = 0) {
  component.dedicated_thread = true;
  component.priority = priority;
  return component;
}

const ComponentStatus& status_of(const std::vector<ComponentStatus>& all, const std::string& name) {
  return *std::ranges::find(all, name, &ComponentStatus::name);
}

TEST(DedicatedThread, TicksWhileEveryWorkerIsBusy) {
  Registry registry = test::standard_registry();
  std::atomic<int> ticks = 0;
  bool ticked = false;
  add_ticker(registry, [&](Context&, Time) { ++ticks; });
  test::add_sink(registry, [&](Context& context, const Plan&) {
    const int before = ticks;
    ticked = happens([&] { return ticks > before + 20; });
    context.request_stop("enough");
  });
  GraphSpec graph;
  graph.components = {spec("source", "source"), spec("relay", "relay"), spec("sink", "sink"),
                      dedicated(spec("ticker", "ticker"))};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "enough");
  EXPECT_TRUE(ticked);
  const auto status = runtime.status();
  EXPECT_EQ(status_of(status, "ticker").thread, "dedicated");
  EXPECT_EQ(status_of(status, "sink").thread, "pool");
  EXPECT_GE(status_of(status, "ticker").timers, 20u);
}

TEST(DedicatedThread, CallsMessagesAndTimersFromOneThread) {
  Registry registry = test::standard_registry();
  std::mutex mutex;
  std::set<std::thread::id> own;
  std::set<std::thread::id> pool;
  int messages = 0;
  int ticks = 0;
  ComponentClass both{.name = "both"};
  both.description.input<msgs::topics::Plan>();
  const auto check = [&](Context& context) {
    const std::lock_guard lock(mutex);
    own.insert(std::this_thread::get_id());
    if (messages >= 5 && ticks >= 5) context.request_stop("enough");
  };
  both.make = [&](Context& context) {
    context.input<msgs::topics::Plan>([&](const std::shared_ptr<const Plan>&) {
      ++messages;
      check(context);
    });
    context.every(Duration::milliseconds(1), [&](Time) {
      ++ticks;
      check(context);
    });
    return std::make_unique<Component>();
  };
  registry.add(std::move(both));
  add_ticker(registry, [&](Context&, Time) {
    const std::lock_guard lock(mutex);
    pool.insert(std::this_thread::get_id());
  });
  GraphSpec graph;
  graph.components = {spec("source", "source"), spec("relay", "relay"), spec("ticker", "ticker"),
                      dedicated(spec("both", "both"))};
  graph.components[0].parameters = {{"rate_hz", 500.0, {}}};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal, .threads = 2});
  EXPECT_EQ(runtime.run().reason, "enough");
  ASSERT_EQ(own.size(), 1u);
  EXPECT_FALSE(pool.contains(*own.begin()));
}

TEST(DedicatedThread, SkipsAndCountsLateTicks) {
  Registry registry;
  std::vector<Time> due;
  add_ticker(registry, [&](Context& context, Time time) {
    due.push_back(time);
    if (due.size() == 3) context.request_stop("enough");
    const Time start = context.now();
    happens([&] { return context.now() - start > Duration::milliseconds(5); });
  });
  GraphSpec graph;
  graph.components = {dedicated(spec("ticker", "ticker"))};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal});
  runtime.run();
  ASSERT_EQ(due.size(), 3u);
  // Calls are whole multiples of the period apart; the ticks between were counted.
  std::int64_t left_out = 0;
  for (std::size_t i = 1; i < due.size(); ++i) {
    const std::int64_t apart_ns = (due[i] - due[i - 1]).count_ns();
    EXPECT_EQ(apart_ns % 1'000'000, 0);
    EXPECT_GE(apart_ns, 5'000'000);
    left_out += apart_ns / 1'000'000 - 1;
  }
  EXPECT_GE(static_cast<std::int64_t>(runtime.status()[0].missed_timers), left_out);
  EXPECT_GE(left_out, 8);
}

TEST(DedicatedThread, ReportsWhetherItsPriorityWasGranted) {
  Registry registry;
  add_ticker(registry, [&](Context& context, Time) { context.request_stop("enough"); });
  GraphSpec graph;
  graph.components = {dedicated(spec("ticker", "ticker"), 20)};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal});
  EXPECT_EQ(runtime.run().reason, "enough");
  const std::string thread = runtime.status()[0].thread;
  const bool granted = thread.starts_with("dedicated, SCHED_FIFO 20;");
  const bool refused = thread.starts_with("dedicated; SCHED_FIFO refused: ");
  EXPECT_TRUE(granted || refused) << thread;
  EXPECT_NE(thread.find("; memory "), std::string::npos) << thread;
}

TEST(DedicatedThread, StopsWithoutTimersAndFromAnotherThread) {
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context&, const Plan&) {});
  GraphSpec graph;
  graph.components = {dedicated(spec("source", "source")), dedicated(spec("relay", "relay")),
                      dedicated(spec("sink", "sink"))};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal});
  std::thread stopper([&] { runtime.request_stop("signal"); });
  EXPECT_EQ(runtime.run().reason, "signal");
  stopper.join();
}

TEST(DedicatedThread, AThrowingCallbackStopsTheRun) {
  Registry registry;
  add_ticker(registry, [](Context&, Time) { throw std::runtime_error("broken"); });
  GraphSpec graph;
  graph.components = {dedicated(spec("ticker", "ticker"))};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal});
  const RunResult result = runtime.run();
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(result.reason, "component 'ticker' failed: broken");
}

TEST(DedicatedThread, HasNoEffectInLockstep) {
  for (const bool own : {false, true}) {
    Registry registry;
    std::vector<Time> due;
    add_ticker(registry, [&](Context& context, Time time) {
      due.push_back(time);
      if (due.size() == 10) context.request_stop("enough");
    });
    GraphSpec graph;
    graph.components = {spec("ticker", "ticker")};
    graph.components[0].dedicated_thread = own;
    Runtime runtime(graph, registry, {.clock = ClockMode::kLockstep});
    runtime.run();
    ASSERT_EQ(due.size(), 10u);
    EXPECT_EQ(due.back(), Time() + Duration::milliseconds(10));
    EXPECT_EQ(runtime.status()[0].timer_late_max, Duration());
    EXPECT_EQ(runtime.status()[0].thread, "pool");
  }
}

}  // namespace
}  // namespace furrow::graph
