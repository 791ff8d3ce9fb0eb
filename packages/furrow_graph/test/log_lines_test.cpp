// What components write to the log, and how it reaches readers in the process.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_log/log.hpp"
#include "furrow_msgs/rcl_interfaces.h"

namespace furrow::graph {
namespace {

using test::spec;

class Memory final : public log::Sink {
 public:
  bool write(const log::Line& line) override {
    texts.push_back(std::to_string(line.time.count_ns() / 1'000'000) + " ms " +
                    std::string(log::to_string(line.level)) + " " + line.component + ": " +
                    log::text_of(line));
    return true;
  }
  std::vector<std::string> texts;
};

using Texts = std::vector<std::string>;
using Step = std::function<void(Context&, int)>;

/// A component that is called every 10 ms with the number of the call.
void add_stepper(Registry& registry, const std::string& name, Step step) {
  ComponentClass type{.name = name};
  type.make = [step = std::move(step)](Context& context) {
    context.every(Duration::milliseconds(10),
                  [&context, step, count = 0](Time) mutable { step(context, ++count); });
    return std::make_unique<Component>();
  };
  registry.add(std::move(type));
}

/// The lines of a lock-step run of components whose classes are named like them.
Texts lines_of(Registry& registry, const std::vector<std::string>& names, int threads = 1) {
  log::LogOptions options;
  options.order = log::Order::kTime;
  options.levels.set("debug");
  log::Log log(options);
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  GraphSpec graph;
  for (const std::string& name : names) graph.components.push_back(spec(name, name));
  {
    Runtime runtime(graph, registry,
                    {.clock = ClockMode::kLockstep, .threads = threads, .log = &log});
    EXPECT_FALSE(runtime.run().failed);
  }
  log.flush();
  return sink->texts;
}

TEST(LogLines, HealthChangeIsOneLine) {
  Registry registry;
  add_stepper(registry, "tracker", [](Context& context, int count) {
    if (count < 3) context.health(HealthLevel::kWarn, "no pose; no image was used");
    if (count == 3) context.health(HealthLevel::kError, "no odometry; tracks are stale");
    if (count >= 4) context.health(HealthLevel::kOk, "");
    if (count == 6) context.request_stop("enough");
  });
  EXPECT_EQ(lines_of(registry, {"tracker"}),
            (Texts{"10 ms warn tracker: no pose; no image was used",
                   "30 ms error tracker: no odometry; tracks are stale",
                   "40 ms info tracker: ok again"}));
}

TEST(LogLines, WarningIsCountedToo) {
  Registry registry;
  add_stepper(registry, "planner", [](Context& context, int count) {
    context.warn("bad_tracks", "position of track 3 is not finite; it was not planned for");
    if (count == 2) context.request_stop("enough");
  });
  log::Log log;
  GraphSpec graph;
  graph.components = {spec("planner", "planner")};
  Runtime runtime(graph, registry, {.clock = ClockMode::kLockstep, .threads = 1, .log = &log});
  EXPECT_FALSE(runtime.run().failed);
  EXPECT_EQ(runtime.status()[0].health.counters.at("bad_tracks"), 2);
  EXPECT_EQ(log.counters().suppressed, 1u);
}

TEST(LogLines, DroppedMessagesAreLogged) {
  Registry registry = test::standard_registry();
  ComponentClass slow{.name = "slow"};
  slow.description.input<msgs::topics::Tracks>();
  slow.make = [](Context& context) {
    context.input<msgs::topics::Tracks>([](const auto&) {}, 1);
    context.every(Duration::milliseconds(1000),
                  [&context](Time) { context.request_stop("enough"); });
    return std::make_unique<Component>();
  };
  registry.add(std::move(slow));
  ComponentClass burst{.name = "burst"};
  burst.description.output<msgs::topics::Tracks>();
  burst.make = [](Context& context) {
    auto out = context.output<msgs::topics::Tracks>();
    context.every(Duration::milliseconds(500), [out](Time) {
      for (int i = 0; i < 4; ++i) out.publish(furrow_msgs::msg::Tracks());
    });
    return std::make_unique<Component>();
  };
  registry.add(std::move(burst));
  const Texts lines = lines_of(registry, {"slow", "burst"});
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines[0],
            "500 ms warn slow: mailbox of 'tracker/tracks' was full; 3 of its messages dropped");
}

TEST(LogLines, LockstepWritesTheSameLinesOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    Registry registry;
    for (const char* name : {"c", "a", "b"}) {
      add_stepper(registry, name, [](Context& context, int count) {
        context.log(log::Level::kInfo, std::string(static_cast<std::size_t>(count % 7), 'x'));
        context.health(count % 3 == 0 ? HealthLevel::kWarn : HealthLevel::kOk, "third");
        if (count == 50) context.request_stop("enough");
      });
    }
    return lines_of(registry, {"c", "a", "b"}, threads);
  };
  const Texts expected = run(1);
  EXPECT_GT(expected.size(), 20u);
  for (int turn = 0; turn < 5; ++turn) EXPECT_EQ(run(4), expected);
}

TEST(LogLines, ReaderInTheProcessGetsThemOnRosout) {
  Registry registry;
  add_stepper(registry, "axis", [](Context& context, int count) {
    if (count == 1) context.log(log::Level::kError, "valve does not answer; it is shut");
    if (count == 20) context.log(log::Level::kInfo, "later");
    if (count == 30) context.request_stop("enough");
  });
  std::vector<rcl_interfaces::msg::Log> seen;
  ComponentClass reader{.name = "reader"};
  reader.description.input<msgs::topics::Rosout>(Need::kOptional);
  reader.make = [&seen](Context& context) {
    context.input<msgs::topics::Rosout>([&seen](const auto& message) { seen.push_back(*message); });
    return std::make_unique<Component>();
  };
  registry.add(std::move(reader));
  (void)lines_of(registry, {"axis", "reader"});
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen[0].name(), "axis");
  EXPECT_EQ(seen[0].msg(), "valve does not answer; it is shut");
  EXPECT_EQ(seen[0].level(), rcl_interfaces::msg::Log_Constants::ERROR);
  EXPECT_EQ(seen[0].stamp().nanosec(), 10'000'000u);
}

TEST(LogLines, ComponentsGetNoTextOfALibraryInLockstep) {
  log::LogOptions options;
  options.order = log::Order::kTime;
  log::Log log(options);
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  Registry registry;
  add_stepper(registry, "axis", [&log](Context& context, int count) {
    if (count == 1) log.write_foreign(log::Level::kError, "opencv", "bad image");
    if (count == 2) context.log(log::Level::kInfo, "own");
    if (count == 3) context.log(log::Level::kInfo, "later");
    if (count == 5) context.request_stop("enough");
  });
  Texts seen;
  ComponentClass reader{.name = "reader"};
  reader.description.input<msgs::topics::Rosout>(Need::kOptional);
  reader.make = [&seen](Context& context) {
    context.input<msgs::topics::Rosout>(
        [&seen](const auto& message) { seen.push_back(message->msg()); });
    return std::make_unique<Component>();
  };
  registry.add(std::move(reader));
  GraphSpec graph;
  graph.components = {spec("axis", "axis"), spec("reader", "reader")};
  Runtime runtime(graph, registry, {.clock = ClockMode::kLockstep, .threads = 1, .log = &log});
  EXPECT_FALSE(runtime.run().failed);
  EXPECT_EQ(seen, (Texts{"own"}));
  log.flush();
  ASSERT_EQ(sink->texts.size(), 3u);
  EXPECT_EQ(sink->texts[0], "0 ms error opencv: bad image");
}

TEST(LogLines, FaultsOfTheTransportAreWarnings) {
  Registry registry;
  add_stepper(registry, "axis", [](Context& context, int count) {
    if (count == 120) context.request_stop("enough");
  });
  registry.add([] {
    ComponentClass reader{.name = "reader"};
    reader.description.input<msgs::topics::Diagnostics>(Need::kOptional);
    reader.make = [](Context& context) {
      context.input<msgs::topics::Diagnostics>([](const auto&) {});
      return std::make_unique<Component>();
    };
    return reader;
  }());
  log::Log log;
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  GraphSpec graph;
  graph.components = {spec("axis", "axis"), spec("reader", "reader")};
  Runtime runtime(graph, registry,
                  {.clock = ClockMode::kReal,
                   .threads = 1,
                   .transport_health =
                       [] {
                         return Health{.level = HealthLevel::kWarn,
                                       .message = "deadline_missed/planner/plan 1",
                                       .counters = {}};
                       },
                   .log = &log});
  EXPECT_FALSE(runtime.run().failed);
  log.flush();
  ASSERT_FALSE(sink->texts.empty());
  EXPECT_TRUE(sink->texts[0].ends_with("warn transport: deadline_missed/planner/plan 1"))
      << sink->texts[0];
}

}  // namespace
}  // namespace furrow::graph
