#include "furrow_launch/run_observer.hpp"

#include <gtest/gtest.h>

#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::launch {
namespace {

namespace topics = msgs::topics;

/// Publishes a status ten times a second, and is finished after `seconds`.
graph::ComponentClass world(double seconds) {
  graph::ComponentClass type{.name = "world"};
  type.description.output<topics::RunStatus>();
  type.make = [seconds](graph::Context& context) {
    auto out = context.output<topics::RunStatus>();
    context.every(Duration::milliseconds(100), [seconds, out](Time now) {
      furrow_msgs::msg::RunStatus status;
      status.distance_m(now.to_seconds());
      status.finished(now.to_seconds() >= seconds);
      out.publish(std::move(status));
    });
    return std::make_unique<graph::Component>();
  };
  return type;
}

/// Answers the end of the run with a record, as the scorer does.
graph::ComponentClass scorer() {
  graph::ComponentClass type{.name = "scorer"};
  type.description.input<topics::RunStatus>().output<topics::RunRecord>();
  type.make = [](graph::Context& context) {
    auto out = context.output<topics::RunRecord>();
    context.input<topics::RunStatus>([out](const auto& status) {
      if (!status->finished()) return;
      furrow_msgs::msg::RunRecord record;
      record.distance_m(status->distance_m());
      out.publish(std::move(record));
    });
    return std::make_unique<graph::Component>();
  };
  return type;
}

graph::RunResult run(RunObserver& observer, std::vector<graph::ComponentClass> classes) {
  graph::Registry registry;
  graph::GraphSpec spec;
  for (graph::ComponentClass& type : classes) {
    spec.components.push_back({.name = type.name, .group = type.name, .class_name = type.name});
    registry.add(std::move(type));
  }
  observer.add_to(spec, registry);
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  return runtime.run();
}

TEST(RunObserver, EndsWithTheRecordOfAFinishedRun) {
  RunObserver observer([](const auto&) {}, RunEnd::kRecord);
  EXPECT_EQ(run(observer, {world(5.0), scorer()}).reason, "finished");
  ASSERT_NE(observer.record(), nullptr);
  EXPECT_DOUBLE_EQ(observer.record()->distance_m(), 5.0);
}

TEST(RunObserver, InterruptEndsTheRunWithTheRecordSoFar) {
  std::optional<RunObserver> observer;
  observer.emplace(
      [&observer](const auto& status) {
        if (status.distance_m() >= 2.0) observer->interrupt();
      },
      RunEnd::kRecord);
  EXPECT_EQ(run(*observer, {world(60.0), scorer()}).reason, "finished");
  ASSERT_NE(observer->record(), nullptr);
  EXPECT_NEAR(observer->record()->distance_m(), 2.0, 0.21);
}

TEST(RunObserver, InterruptEndsARunWhoseScorerDoesNotAnswer) {
  std::optional<RunObserver> observer;
  observer.emplace([&observer](const auto&) { observer->interrupt(); }, RunEnd::kRecord);
  const graph::RunResult result = run(*observer, {world(60.0)});
  EXPECT_EQ(result.reason, "interrupted");
  EXPECT_EQ(observer->record(), nullptr);
  EXPECT_LT(result.end.to_seconds(), 2.0);
}

}  // namespace
}  // namespace furrow::launch
