// Lock-step of several processes. Each process is a runtime on a thread of the test; a network in
// memory connects them.

#include <algorithm>
#include <array>
#include <future>
#include <thread>

#include "../src/step.hpp"
#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"
#include "memory_network.hpp"

namespace furrow::graph {
namespace {

using furrow_msgs::msg::Plan;
using furrow_msgs::msg::Tracks;
using test::spec;

/// Answers every second plan with tracks, which makes a cycle over processes.
class Echo final : public Component {
 public:
  static void describe(Description& d) {
    d.input<msgs::topics::Plan>().output<msgs::topics::Tracks>();
  }
  explicit Echo(Context& context) {
    auto out = context.output<msgs::topics::Tracks>();
    Tracks first;
    first.header().frame_id("echo:start");
    out.publish(std::move(first));
    context.input<msgs::topics::Plan>([&context, out](const std::shared_ptr<const Plan>& plan) {
      if (plan->header().frame_id().starts_with("echo") || plan->revision() % 2 == 0) return;
      Tracks tracks;
      tracks.header().frame_id("echo:" + context.name() + plan->header().frame_id());
      out.publish(std::move(tracks));
    });
  }
};

/// Three sources at different rates, a relay, two components that answer it, and a sink that
/// records the plans and ends the run.
GraphSpec cyclic_graph() {
  GraphSpec graph;
  constexpr std::array<double, 3> kRates_hz = {10.0, 25.0, 40.0};
  for (std::size_t i = 0; i < kRates_hz.size(); ++i) {
    graph.components.push_back(spec("s" + std::to_string(i), "source"));
    graph.components.back().parameters = {{"rate_hz", kRates_hz[i], {}},
                                          {"label", "s" + std::to_string(i) + ":", {}}};
  }
  for (const auto& [name, type] :
       {std::pair{"e0", "echo"}, {"r", "relay"}, {"e1", "echo"}, {"sink", "sink"}}) {
    graph.components.push_back(spec(name, type));
  }
  return graph;
}

struct Outcome {
  std::string transcript;
  RunResult result;
};

Outcome run_process(const GraphSpec& graph, const std::vector<PlacedProcess>& processes,
                    const PlacedProcess& mine, Transport* transport, int threads,
                    std::uint64_t seed = 1) {
  Registry registry = test::standard_registry();
  registry.add<Echo>("echo");
  Outcome outcome;
  int plans = 0;
  test::add_sink(registry, [&](Context& context, const Plan& plan) {
    outcome.transcript += std::to_string(context.now().count_ns()) + " " +
                          plan.header().frame_id() + " " + std::to_string(plan.revision()) + "\n";
    if (++plans == 200) context.request_stop("enough");
  });
  Runtime runtime(graph, registry,
                  {.clock = ClockMode::kLockstep,
                   .threads = threads,
                   .seed = seed,
                   .components = mine.components,
                   .transport = transport,
                   .process = mine.name,
                   .processes = processes});
  outcome.result = runtime.run();
  return outcome;
}

/// Runs every process and returns their transcripts together.
std::string transcript(const std::vector<std::vector<std::string>>& components,
                       std::uint64_t network_seed, int threads) {
  const GraphSpec graph = cyclic_graph();
  std::vector<PlacedProcess> processes;
  for (std::size_t i = 0; i < components.size(); ++i) {
    processes.push_back({.name = "p" + std::to_string(i), .components = components[i]});
  }
  test::MemoryNetwork network(network_seed);
  std::vector<std::unique_ptr<Transport>> ends;
  std::vector<std::future<Outcome>> running;
  for (std::size_t i = 0; i < processes.size(); ++i) {
    ends.push_back(std::make_unique<test::MemoryNetwork::Endpoint>(network, static_cast<int>(i)));
    running.push_back(std::async(std::launch::async, [&, i, end = ends.back().get()] {
      return run_process(graph, processes, processes[i], end, threads);
    }));
  }
  std::string all;
  for (auto& process : running) {
    const Outcome outcome = process.get();
    EXPECT_EQ(outcome.result.reason, "enough");
    EXPECT_FALSE(outcome.result.failed);
    all += outcome.transcript;
  }
  return all;
}

TEST(SharedLockstep, GivesOneTranscriptForEveryPlacement) {
  const std::string alone = transcript({{"s0", "s1", "s2", "e0", "r", "e1", "sink"}}, 1, 1);
  ASSERT_GE(std::count(alone.begin(), alone.end(), '\n'), 200);
  EXPECT_NE(alone.find("echo:e0s1"), std::string::npos);
  EXPECT_NE(alone.find("echo:e1s1"), std::string::npos);
  const std::vector<std::vector<std::vector<std::string>>> placements = {
      {{"s0", "s1", "s2", "e0", "e1", "sink"}, {"r"}},
      {{"sink", "s1"}, {"s0", "r", "s2", "e0", "e1"}},
      {{"e1", "s2"}, {"s1", "r", "e0"}, {"s0", "sink"}},
      {{"s0"}, {"s1"}, {"s2"}, {"e0"}, {"r"}, {"e1"}, {"sink"}},
  };
  for (std::size_t i = 0; i < placements.size(); ++i) {
    for (const std::uint64_t network_seed : {3, 4}) {
      EXPECT_EQ(transcript(placements[i], network_seed, 1 + static_cast<int>(i) % 2), alone)
          << "placement " << i << ", network " << network_seed;
    }
  }
}

std::vector<PlacedProcess> two_processes() {
  return {{.name = "one", .components = {"s0", "s1", "s2", "e0", "r"}},
          {.name = "two", .components = {"e1", "sink"}}};
}

TEST(SharedLockstep, BothProcessesReportADifferentSeed) {
  test::MemoryNetwork network(1);
  test::MemoryNetwork::Endpoint first(network, 0);
  test::MemoryNetwork::Endpoint second(network, 1);
  const GraphSpec graph = cyclic_graph();
  const auto processes = two_processes();
  auto other = std::async(std::launch::async, [&] {
    return run_process(graph, processes, processes[1], &second, 1, 2);
  });
  const Outcome mine = run_process(graph, processes, processes[0], &first, 1, 1);
  EXPECT_TRUE(mine.result.failed);
  EXPECT_EQ(mine.result.reason, "process 'two' runs another graph, deployment, seed or parameters");
  EXPECT_EQ(other.get().result.reason,
            "process 'one' runs another graph, deployment, seed or parameters");
}

TEST(SharedLockstep, AnInterruptionEndsAllProcesses) {
  test::MemoryNetwork network(1);
  test::MemoryNetwork::Endpoint first(network, 0);
  test::MemoryNetwork::Endpoint second(network, 1);
  const GraphSpec graph = cyclic_graph();
  const auto processes = two_processes();
  Registry registry = test::standard_registry();
  registry.add<Echo>("echo");
  std::promise<void> started;
  bool once = false;
  test::add_sink(registry, [&](Context&, const Plan&) {
    if (!std::exchange(once, true)) started.set_value();
  });
  auto other = std::async(std::launch::async, [&] {
    Registry others = test::standard_registry();
    others.add<Echo>("echo");
    test::add_sink(others, [](Context&, const Plan&) {});
    Runtime runtime(graph, others,
                    {.clock = ClockMode::kLockstep,
                     .components = processes[0].components,
                     .transport = &first,
                     .process = "one",
                     .processes = processes});
    return runtime.run();
  });
  Runtime runtime(graph, registry,
                  {.clock = ClockMode::kLockstep,
                   .components = processes[1].components,
                   .transport = &second,
                   .process = "two",
                   .processes = processes});
  std::thread signal([&] {
    started.get_future().wait();
    runtime.request_stop("interrupted");
  });
  EXPECT_EQ(runtime.run().reason, "interrupted");
  const RunResult result = other.get();
  EXPECT_EQ(result.reason, "process 'two' left: interrupted");
  EXPECT_TRUE(result.failed);
  signal.join();
}

TEST(SharedLockstep, AFailureInOneProcessEndsAll) {
  test::MemoryNetwork network(1);
  test::MemoryNetwork::Endpoint first(network, 0);
  test::MemoryNetwork::Endpoint second(network, 1);
  const GraphSpec graph = cyclic_graph();
  const auto processes = two_processes();
  auto other = std::async(std::launch::async, [&] {
    Registry registry = test::standard_registry();
    registry.add<Echo>("echo");
    test::add_sink(registry, [](Context&, const Plan&) { throw std::runtime_error("broken"); });
    Runtime runtime(graph, registry,
                    {.clock = ClockMode::kLockstep,
                     .components = processes[1].components,
                     .transport = &second,
                     .process = "two",
                     .processes = processes});
    return runtime.run();
  });
  const Outcome mine = run_process(graph, processes, processes[0], &first, 1);
  EXPECT_TRUE(mine.result.failed);
  EXPECT_EQ(mine.result.reason, "component 'sink' failed: broken");
  EXPECT_EQ(other.get().reason, mine.result.reason);
}

Step sample_step() {
  Step step{.number = 5,
            .run = 6,
            .instance = 7,
            .next_timer_ns = -8,
            .process = "p",
            .stop = true,
            .failed = true,
            .reason = "why",
            .topics = {1, 4}};
  step.messages = {{1, 2, {std::byte{3}}}, {4, 5, {}}};
  return step;
}

TEST(Step, RoundTripsThroughCdr) {
  const Step step = sample_step();
  std::vector<std::byte> bytes(step_type().serialized_size(&step));
  ASSERT_TRUE(step_type().serialize(&step, bytes).ok());
  Step copy;
  ASSERT_TRUE(step_type().deserialize(bytes, &copy).ok());
  EXPECT_EQ(copy.number, 5u);
  EXPECT_EQ(copy.run, 6u);
  EXPECT_EQ(copy.instance, 7u);
  EXPECT_EQ(copy.next_timer_ns, -8);
  EXPECT_EQ(copy.process, "p");
  EXPECT_TRUE(copy.stop && copy.failed);
  EXPECT_FALSE(copy.aborted);
  EXPECT_EQ(copy.reason, "why");
  EXPECT_EQ(copy.topics, step.topics);
  ASSERT_EQ(copy.messages.size(), 2u);
  EXPECT_EQ(copy.messages[0].cdr, step.messages[0].cdr);
  EXPECT_EQ(copy.messages[1].component, 5u);
}

TEST(Step, TruncatedOrOversizedDataIsAnError) {
  const Step step = sample_step();
  std::vector<std::byte> bytes(step_type().serialized_size(&step));
  ASSERT_TRUE(step_type().serialize(&step, bytes).ok());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Step copy;
    EXPECT_FALSE(step_type().deserialize(std::span(bytes).first(size), &copy).ok()) << size;
  }
  // A length greater than any buffer.
  std::vector<std::byte> huge = bytes;
  std::ranges::fill(huge.begin() + 4, huge.end(), std::byte{0x7F});
  Step copy;
  EXPECT_FALSE(step_type().deserialize(huge, &copy).ok());
  std::vector<std::byte> small(bytes.size() - 1);
  EXPECT_FALSE(step_type().serialize(&step, small).ok());
}

}  // namespace
}  // namespace furrow::graph
