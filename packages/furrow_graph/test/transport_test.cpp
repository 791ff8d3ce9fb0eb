// The graph with a transport that records its calls.

#include <map>

#include "fake_transport.hpp"
#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/diagnostic_msgs.h"

namespace furrow::graph {
namespace {

using test::spec;

GraphSpec source_relay_sink() {
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay"), spec("sink", "sink")};
  return graph;
}

void run_three_plans(test::FakeTransport& transport, std::vector<std::string> components) {
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context& context, const furrow_msgs::msg::Plan& plan) {
    if (plan.revision() == 3) context.request_stop("enough");
  });
  Runtime runtime(source_relay_sink(), registry,
                  {.clock = ClockMode::kLockstep,
                   .components = std::move(components),
                   .transport = &transport});
  for (const auto& [topic, deliver] : transport.receivers) {
    for (int i = 0; i < 3; ++i) deliver(std::make_shared<const furrow_msgs::msg::Tracks>());
  }
  runtime.run();
}

TEST(Transport, NothingIsWrittenWithoutAnExternalSubscriber) {
  test::FakeTransport transport;
  transport.has_external_subscribers = false;
  run_three_plans(transport, {});
  EXPECT_TRUE(transport.written("tracker/tracks").empty());
  EXPECT_TRUE(transport.written("planner/plan").empty());
  EXPECT_TRUE(transport.receivers.empty());  // this process publishes every topic
}

TEST(Transport, AnExternalSubscriberGetsEveryMessage) {
  test::FakeTransport transport;
  run_three_plans(transport, {});
  EXPECT_EQ(transport.written("tracker/tracks").size(), 3u);
  EXPECT_EQ(transport.written("planner/plan").size(), 3u);
}

TEST(Transport, ReadsTopicsOfOtherProcesses) {
  test::FakeTransport transport;
  run_three_plans(transport, {"r", "sink"});
  ASSERT_EQ(transport.receivers.size(), 1u);
  EXPECT_TRUE(transport.receivers.contains("tracker/tracks"));
}

/// The messages on `diagnostics` in 2.5 s of simulated time, in CDR form.
std::vector<std::vector<std::byte>> diagnostics(int threads) {
  test::FakeTransport transport;
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context& context, const furrow_msgs::msg::Plan& plan) {
    context.count("plans");
    if (plan.revision() % 2 == 0) context.health(HealthLevel::kWarn, "even");
    if (plan.revision() == 25) context.request_stop("enough");
  });
  Runtime runtime(source_relay_sink(), registry,
                  {.clock = ClockMode::kLockstep,
                   .threads = threads,
                   .transport = &transport,
                   .process = "p",
                   .transport_health = [] { return Health(); }});
  runtime.run();
  std::vector<std::vector<std::byte>> forms;
  const msgs::MessageType& type = *msgs::topics::Diagnostics::topic().type;
  for (const MessagePtr& message : transport.written("diagnostics")) {
    auto& form = forms.emplace_back(type.serialized_size(message.get()));
    EXPECT_TRUE(type.serialize(message.get(), form).ok());
  }
  return forms;
}

TEST(Transport, PublishesHealthEverySecondWithoutWallClockTimes) {
  const auto forms = diagnostics(1);
  ASSERT_EQ(forms.size(), 2u);
  EXPECT_EQ(forms, diagnostics(3));
  diagnostic_msgs::msg::DiagnosticArray array;
  ASSERT_TRUE(msgs::topics::Diagnostics::topic().type->deserialize(forms[0], &array).ok());
  EXPECT_EQ(array.header().stamp().sec(), 1);
  // A status for each component; none for the transport, whose counters depend on wall-clock time.
  ASSERT_EQ(array.status().size(), 3u);
  const auto& sink = array.status()[2];
  EXPECT_EQ(sink.name(), "p: sink");
  EXPECT_EQ(sink.hardware_id(), "p");
  EXPECT_EQ(sink.level(), 1);
  EXPECT_EQ(sink.message(), "even");
  std::map<std::string, std::string> values;
  for (const auto& value : sink.values()) values[value.key()] = value.value();
  // Nine plans, at the tenths of a second before the first second.
  EXPECT_EQ(values["count/plans"], "9");
  EXPECT_EQ(values["received"], "9");
  EXPECT_EQ(values["dropped"], "0");
  EXPECT_FALSE(values.contains("busy_s"));
}

}  // namespace
}  // namespace furrow::graph
