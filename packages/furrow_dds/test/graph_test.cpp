// A graph that runs in real time on a DDS transport.

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"
#include "test_support.hpp"

namespace furrow::dds {
namespace {

namespace topics = msgs::topics;

/// Publishes a plan and instances for each tracks message, after computing for a millisecond.
graph::Registry pair_registry() {
  graph::Registry registry;
  graph::ComponentClass pair{.name = "pair"};
  pair.description.input<topics::Tracks>().output<topics::Plan>().output<topics::Instances>();
  pair.make = [](graph::Context& context) {
    auto plan = context.output<topics::Plan>();
    auto instances = context.output<topics::Instances>();
    context.input<topics::Tracks>([plan, instances](const auto&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      plan.publish(topics::Plan::Message());
      instances.publish(topics::Instances::Message());
    });
    return std::make_unique<graph::Component>();
  };
  registry.add(std::move(pair));
  return registry;
}

std::unique_ptr<graph::TransportReader> read(DdsTransport& transport, const msgs::Topic& topic,
                                             Inbox<graph::MessagePtr>& inbox) {
  return transport.make_reader(std::string(topic.name), *topic.type, topic.qos,
                               [&inbox](graph::MessagePtr message) { inbox.put(message); });
}

TEST(RealtimeGraph, EveryTopicOfACallbackLeavesTheProcessWithoutAnotherEvent) {
  DdsTransport inside(test_parameters("inside"));
  graph::Registry registry = pair_registry();
  graph::GraphSpec spec;
  spec.components = {{.name = "pair", .group = "pair", .class_name = "pair"}};
  spec.external = {"tracker/tracks"};
  graph::Runtime runtime(spec, registry, {.transport = &inside});

  DdsTransport outside(test_parameters("outside"));
  Inbox<graph::MessagePtr> plans;
  Inbox<graph::MessagePtr> instances;
  Inbox<graph::MessagePtr> seconds;
  const auto plan_reader = read(outside, topics::Plan::topic(), plans);
  const auto instance_reader = read(outside, topics::Instances::topic(), instances);
  const auto diagnostics_reader = read(outside, topics::Diagnostics::topic(), seconds);
  const msgs::Topic& tracks = topics::Tracks::topic();
  const auto writer = outside.make_writer(std::string(tracks.name), *tracks.type, tracks.qos);
  auto run = std::async(std::launch::async, [&] { return runtime.run(); });
  const auto peers = [](const DdsTransport& transport) {
    int count = 0;
    for (const EndpointStatus& endpoint : transport.status()) count += endpoint.peers;
    return count;
  };
  ASSERT_TRUE(eventually([&] { return peers(inside) == 4 && peers(outside) == 4; }));

  constexpr std::size_t kRounds = 8;
  const std::size_t before = seconds.items().size();
  for (std::size_t round = 1; round <= kRounds; ++round) {
    writer->write(std::make_shared<const topics::Tracks::Message>());
    ASSERT_TRUE(plans.wait_for(round));
    ASSERT_TRUE(instances.wait_for(round));
  }
  // The diagnostics of each second are the only other event in the process.
  EXPECT_LT(seconds.items().size() - before, kRounds / 2);
  runtime.request_stop("enough");
  EXPECT_EQ(run.get().reason, "enough");
}

}  // namespace
}  // namespace furrow::dds
