// Lock-step of several processes. Each process is a runtime on a thread of the test; a network in
// memory connects them.

#include <algorithm>
#include <array>
#include <deque>
#include <future>
#include <thread>

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

using Take = std::function<void(Context&, const Plan&)>;

/// The runtime of one process, whose sink calls `take`.
std::unique_ptr<Runtime> make_runtime(Registry& registry,
                                      const std::vector<PlacedProcess>& processes, std::size_t own,
                                      Transport* transport, Take take, int threads = 1,
                                      std::uint64_t seed = 1) {
  registry = test::standard_registry();
  registry.add<Echo>("echo");
  test::add_sink(registry, std::move(take));
  return std::make_unique<Runtime>(cyclic_graph(), registry,
                                   RuntimeOptions{.clock = ClockMode::kLockstep,
                                                  .threads = threads,
                                                  .seed = seed,
                                                  .components = processes[own].components,
                                                  .transport = transport,
                                                  .process = processes[own].name,
                                                  .processes = processes});
}

/// Runs every process and returns the transcript of the sink.
std::string transcript(const std::vector<std::vector<std::string>>& components,
                       std::uint64_t network_seed, int threads) {
  std::vector<PlacedProcess> processes;
  for (std::size_t i = 0; i < components.size(); ++i) {
    processes.push_back({.name = "p" + std::to_string(i), .components = components[i]});
  }
  std::string text;
  int plans = 0;
  const auto take = [&](Context& context, const Plan& plan) {
    text += std::to_string(context.now().count_ns()) + " " + plan.header().frame_id() + " " +
            std::to_string(plan.revision()) + "\n";
    if (++plans == 200) context.request_stop("enough");
  };
  test::MemoryNetwork network(network_seed);
  std::deque<test::MemoryNetwork::Endpoint> endpoints;
  std::deque<Registry> registries;
  std::vector<std::future<RunResult>> running;
  for (std::size_t i = 0; i < processes.size(); ++i) {
    running.push_back(std::async(
        std::launch::async, [&, i, &endpoint = endpoints.emplace_back(network, static_cast<int>(i)),
                             &registry = registries.emplace_back()] {
          return make_runtime(registry, processes, i, &endpoint, take, threads)->run();
        }));
  }
  for (auto& process : running) {
    const RunResult result = process.get();
    EXPECT_EQ(result.reason, "enough");
    EXPECT_FALSE(result.failed);
  }
  return text;
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

/// Two processes; the second one has the sink.
class TwoProcesses : public testing::Test {
 protected:
  void make(const Take& take, std::uint64_t second_seed = 1) {
    first_ = make_runtime(registries_[0], processes_, 0, &endpoints_[0], {});
    second_ = make_runtime(registries_[1], processes_, 1, &endpoints_[1], take, 1, second_seed);
  }
  void run() {
    auto other = std::async(std::launch::async, [this] { return second_->run(); });
    first_result_ = first_->run();
    second_result_ = other.get();
  }

  const std::vector<PlacedProcess> processes_ = {
      {.name = "one", .components = {"s0", "s1", "s2", "e0", "r"}},
      {.name = "two", .components = {"e1", "sink"}}};
  test::MemoryNetwork network_{1};
  std::array<test::MemoryNetwork::Endpoint, 2> endpoints_{
      test::MemoryNetwork::Endpoint(network_, 0), test::MemoryNetwork::Endpoint(network_, 1)};
  std::array<Registry, 2> registries_;
  std::unique_ptr<Runtime> first_;
  std::unique_ptr<Runtime> second_;
  RunResult first_result_;
  RunResult second_result_;
};

TEST_F(TwoProcesses, ReportADifferentSeed) {
  make([](Context&, const Plan&) {}, 2);
  run();
  EXPECT_TRUE(first_result_.failed);
  EXPECT_EQ(first_result_.reason,
            "process 'two' runs another graph, deployment, seed or parameters");
  EXPECT_EQ(second_result_.reason,
            "process 'one' runs another graph, deployment, seed or parameters");
}

TEST_F(TwoProcesses, EndWhenOneIsInterrupted) {
  std::promise<void> started;
  make([&, once = false](Context&, const Plan&) mutable {
    if (!std::exchange(once, true)) started.set_value();
  });
  std::thread signal([&] {
    started.get_future().wait();
    second_->request_stop("interrupted");
  });
  run();
  signal.join();
  EXPECT_EQ(second_result_.reason, "interrupted");
  EXPECT_EQ(first_result_.reason, "process 'two' left: interrupted");
  EXPECT_TRUE(first_result_.failed);
}

TEST_F(TwoProcesses, FailTogether) {
  make([](Context&, const Plan&) { throw std::runtime_error("broken"); });
  run();
  EXPECT_TRUE(first_result_.failed);
  EXPECT_EQ(first_result_.reason, "component 'sink' failed: broken");
  EXPECT_EQ(second_result_.reason, first_result_.reason);
}

}  // namespace
}  // namespace furrow::graph
