#include "furrow_graph/runtime.hpp"

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include "fixtures.hpp"
#include "furrow_core/test_support/config_error.hpp"

namespace furrow::graph {
namespace {

using furrow_msgs::msg::Plan;
using test::spec;

GraphSpec chain(int sources) {
  GraphSpec graph;
  for (int i = 0; i < sources; ++i) {
    const std::string name = "s" + std::to_string(i);
    graph.components.push_back(spec(name, "source"));
    graph.components.back().parameters = {{"label", name + ":", {}}};
  }
  graph.components.push_back(spec("r", "relay"));
  graph.components.push_back(spec("sink", "sink"));
  return graph;
}

std::string lockstep_transcript(int threads) {
  Registry registry = test::standard_registry();
  std::string transcript;
  test::add_sink(registry, [&](Context& context, const Plan& plan) {
    transcript += std::to_string(context.now().count_ns()) + " " + plan.header().frame_id() + " " +
                  std::to_string(plan.revision()) + "\n";
    if (plan.revision() == 100) context.request_stop("enough");
  });
  Runtime runtime(chain(4), registry, {.clock = ClockMode::kLockstep, .threads = threads});
  const RunResult result = runtime.run();
  EXPECT_EQ(result.reason, "enough");
  EXPECT_FALSE(result.failed);
  // 100 messages of four sources at 10 Hz: the 25th tick, at 2.5 s.
  EXPECT_EQ(result.end, Time::from_nanoseconds(2'500'000'000));
  return transcript;
}

TEST(Lockstep, SameTranscriptOnAnyNumberOfThreads) {
  const std::string one = lockstep_transcript(1);
  EXPECT_EQ(one.substr(0, one.find('\n')), "100000000 s0:0 1");
  EXPECT_EQ(one, lockstep_transcript(2));
  EXPECT_EQ(one, lockstep_transcript(4));
}

TEST(Lockstep, EndsWithoutMessagesAndTimers) {
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context&, const Plan&) {});
  GraphSpec graph;
  graph.components = {spec("r", "relay"), spec("sink", "sink")};
  graph.external = {"tracker/tracks"};
  Runtime runtime(graph, registry, {.clock = ClockMode::kLockstep});
  EXPECT_EQ(runtime.run().reason, "no message or timer is left");
}

TEST(Lockstep, MessagesOfConstructorsArriveAfterAllAreConstructed) {
  Registry registry = test::standard_registry();
  ComponentClass early{.name = "early"};
  early.description.output<msgs::topics::Tracks>();
  early.make = [](Context& context) {
    context.output<msgs::topics::Tracks>().publish(furrow_msgs::msg::Tracks());
    return std::make_unique<Component>();
  };
  registry.add(std::move(early));
  int plans = 0;
  test::add_sink(registry, [&](Context&, const Plan&) { ++plans; });
  GraphSpec graph;
  graph.components = {spec("e", "early"), spec("r", "relay"), spec("sink", "sink")};
  Runtime runtime(graph, registry, {.clock = ClockMode::kLockstep});
  runtime.run();
  EXPECT_EQ(plans, 1);
}

TEST(Lockstep, AFullMailboxDropsAndCountsItsOldestMessage) {
  Registry registry = test::standard_registry();
  ComponentClass burst{.name = "burst"};
  burst.description.output<msgs::topics::Tracks>();
  burst.make = [](Context& context) {
    auto out = context.output<msgs::topics::Tracks>();
    for (int i = 0; i < 12; ++i) {
      furrow_msgs::msg::Tracks tracks;
      tracks.header().frame_id(std::to_string(i));
      out.publish(std::move(tracks));
    }
    return std::make_unique<Component>();
  };
  registry.add(std::move(burst));
  std::string seen;
  test::add_sink(registry,
                 [&](Context&, const Plan& plan) { seen += plan.header().frame_id() + " "; });
  GraphSpec graph;
  graph.components = {spec("b", "burst"), spec("r", "relay"), spec("sink", "sink")};
  Runtime runtime(graph, registry, {.clock = ClockMode::kLockstep});
  runtime.run();
  const auto depth = static_cast<std::uint64_t>(msgs::topics::Tracks::topic().qos.depth);
  std::string expected;
  for (std::uint64_t i = 12 - depth; i < 12; ++i) expected += std::to_string(i) + " ";
  EXPECT_EQ(seen, expected);
  const auto status = runtime.status();
  EXPECT_EQ(status[1].inputs[0].received, 12u);
  EXPECT_EQ(status[1].inputs[0].dropped, 12 - depth);
}

TEST(Runtime, AThrowingCallbackStopsTheRunAndIsNamed) {
  for (const ClockMode clock : {ClockMode::kLockstep, ClockMode::kReal}) {
    Registry registry = test::standard_registry();
    test::add_sink(registry, [](Context&, const Plan&) { throw std::runtime_error("broken"); });
    Runtime runtime(chain(1), registry, {.clock = clock});
    const RunResult result = runtime.run();
    EXPECT_TRUE(result.failed);
    EXPECT_EQ(result.reason, "component 'sink' failed: broken");
  }
}

TEST(Runtime, AThrowingConstructorNamesTheComponent) {
  Registry registry = test::standard_registry();
  ComponentClass bad{.name = "bad"};
  bad.make = [](Context&) -> std::unique_ptr<Component> { throw ConfigError("no such device"); };
  registry.add(std::move(bad));
  GraphSpec graph;
  graph.components = {spec("b", "bad")};
  EXPECT_EQ(error_of("", [&] { Runtime(graph, registry, {}); }), "graph.yaml:1: b: no such device");
}

TEST(Runtime, AnUndescribedPortIsAnError) {
  Registry registry;
  ComponentClass sly{.name = "sly"};
  sly.make = [](Context& context) {
    (void)context.output<msgs::topics::Plan>();
    return std::make_unique<Component>();
  };
  registry.add(std::move(sly));
  GraphSpec graph;
  graph.components = {spec("s", "sly")};
  EXPECT_EQ(error_of("", [&] { Runtime(graph, registry, {}); }),
            "graph.yaml:1: s: class 'sly' does not describe its port 'planner/plan'");
}

TEST(Realtime, DeliversInOrderAndStops) {
  Registry registry = test::standard_registry();
  std::vector<std::uint64_t> revisions;
  test::add_sink(registry, [&](Context& context, const Plan& plan) {
    revisions.push_back(plan.revision());
    if (revisions.size() == 50) context.request_stop("enough");
  });
  GraphSpec graph = chain(1);
  graph.components[0].parameters = {{"rate_hz", 1000.0, {}}};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal, .threads = 3});
  EXPECT_EQ(runtime.run().reason, "enough");
  ASSERT_GE(revisions.size(), 50u);
  EXPECT_TRUE(std::ranges::is_sorted(revisions));
}

TEST(Realtime, CallbacksOfAComponentNeverOverlap) {
  Registry registry = test::standard_registry();
  std::atomic<int> inside = 0;
  std::atomic<bool> overlapped = false;
  std::atomic<int> calls = 0;
  test::add_sink(registry, [&](Context& context, const Plan&) {
    if (inside.fetch_add(1) != 0) overlapped = true;
    std::this_thread::yield();
    inside.fetch_sub(1);
    if (++calls == 400) context.request_stop("enough");
  });
  GraphSpec graph = chain(4);
  for (int i = 0; i < 4; ++i) graph.components[i].parameters = {{"rate_hz", 1000.0, {}}};
  Runtime runtime(graph, registry, {.clock = ClockMode::kReal, .threads = 4});
  runtime.run();
  EXPECT_FALSE(overlapped);
}

TEST(Realtime, StopsFromAnotherThread) {
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context&, const Plan&) {});
  Runtime runtime(chain(2), registry, {.clock = ClockMode::kReal});
  std::thread stopper([&] { runtime.request_stop("signal"); });
  EXPECT_EQ(runtime.run().reason, "signal");
  stopper.join();
}

TEST(Realtime, DeliversTheSameObject) {
  Registry registry = test::standard_registry();
  const void* sent = nullptr;
  std::set<const void*> received;
  ComponentClass maker{.name = "maker"};
  maker.description.output<msgs::topics::Plan>();
  maker.make = [&](Context& context) {
    auto plan = std::make_shared<const Plan>();
    sent = plan.get();
    context.output<msgs::topics::Plan>().publish(std::move(plan));
    return std::make_unique<Component>();
  };
  registry.add(std::move(maker));
  test::add_sink(registry, [&](Context& context, const Plan& plan) {
    received.insert(&plan);
    context.request_stop("got it");
  });
  GraphSpec graph;
  graph.components = {spec("m", "maker"), spec("sink", "sink")};
  Runtime(graph, registry, {.clock = ClockMode::kReal}).run();
  EXPECT_EQ(received, std::set<const void*>{sent});
}

}  // namespace
}  // namespace furrow::graph
