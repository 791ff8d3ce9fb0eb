// What components write to the log, and how it reaches readers in the process.

#include <functional>
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

/// A component that takes the messages of a topic, if they are published.
template <class Topic>
void add_reader(Registry& registry, std::function<void(const typename Topic::Message&)> take) {
  ComponentClass reader{.name = "reader"};
  reader.description.input<Topic>(Need::kOptional);
  reader.make = [take = std::move(take)](Context& context) {
    context.input<Topic>([take](const auto& message) { take(*message); });
    return std::make_unique<Component>();
  };
  registry.add(std::move(reader));
}

/// A log that keeps its lines, and runs that write to it.
struct Logged {
  explicit Logged(log::LogOptions options = {}) : log(std::move(options)) { log.add(sink); }

  /// Runs components whose classes are named like them.
  void run(Registry& registry, const std::vector<std::string>& names, RuntimeOptions options) {
    GraphSpec graph;
    for (const std::string& name : names) graph.components.push_back(spec(name, name));
    options.log = &log;
    Runtime runtime(graph, registry, options);
    EXPECT_FALSE(runtime.run().failed);
    status = runtime.status();
  }

  [[nodiscard]] Texts lines() {
    log.flush();
    return sink->texts;
  }

  std::shared_ptr<Memory> sink = std::make_shared<Memory>();
  log::Log log;
  std::vector<ComponentStatus> status;
};

log::LogOptions by_time() {
  log::LogOptions options;
  options.order = log::Order::kTime;
  options.levels.set("debug");
  return options;
}

/// The lines of a lock-step run.
Texts lines_of(Registry& registry, const std::vector<std::string>& names, int threads = 1) {
  Logged logged(by_time());
  logged.run(registry, names, {.clock = ClockMode::kLockstep, .threads = threads});
  return logged.lines();
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
  Logged logged;
  logged.run(registry, {"planner"}, {.clock = ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(logged.status[0].health.counters.at("bad_tracks"), 2);
  EXPECT_EQ(logged.log.counters().suppressed, 1u);
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
  add_reader<msgs::topics::Rosout>(registry, [&](const auto& line) { seen.push_back(line); });
  (void)lines_of(registry, {"axis", "reader"});
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen[0].name(), "axis");
  EXPECT_EQ(seen[0].msg(), "valve does not answer; it is shut");
  EXPECT_EQ(seen[0].level(), rcl_interfaces::msg::Log_Constants::ERROR);
  EXPECT_EQ(seen[0].stamp().nanosec(), 10'000'000u);
}

TEST(LogLines, ComponentsGetNoTextOfALibraryInLockstep) {
  Logged logged(by_time());
  Registry registry;
  add_stepper(registry, "axis", [&logged](Context& context, int count) {
    if (count == 1) logged.log.write_foreign(log::Level::kError, "opencv", "bad image");
    if (count == 2) context.log(log::Level::kInfo, "own");
    if (count == 3) context.log(log::Level::kInfo, "later");
    if (count == 5) context.request_stop("enough");
  });
  Texts seen;
  add_reader<msgs::topics::Rosout>(registry, [&](const auto& line) { seen.push_back(line.msg()); });
  logged.run(registry, {"axis", "reader"}, {.clock = ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(seen, (Texts{"own"}));
  const Texts lines = logged.lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "0 ms error opencv: bad image");
}

TEST(LogLines, FaultsOfTheTransportAreWarnings) {
  Registry registry;
  add_stepper(registry, "axis", [](Context& context, int count) {
    if (count == 120) context.request_stop("enough");
  });
  add_reader<msgs::topics::Diagnostics>(registry, [](const auto&) {});
  const auto fault = [] {
    return Health{HealthLevel::kWarn, "deadline_missed/planner/plan 1", {}};
  };
  Logged logged;
  logged.run(registry, {"axis", "reader"},
             {.clock = ClockMode::kReal, .threads = 1, .transport_health = fault});
  const Texts lines = logged.lines();
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines[0].ends_with("warn transport: deadline_missed/planner/plan 1")) << lines[0];
}

}  // namespace
}  // namespace furrow::graph
