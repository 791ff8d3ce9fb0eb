#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "furrow_dds/discovery_server.hpp"
#include "test_support.hpp"

namespace furrow::dds {
namespace {

const ProcessInfo* find_process(const DiscoverySnapshot& snapshot, const std::string& name) {
  const auto found = std::ranges::find(snapshot.processes, name, &ProcessInfo::name);
  return found == snapshot.processes.end() ? nullptr : &*found;
}

const TopicInfo* find_topic(const DiscoverySnapshot& snapshot, const std::string& name) {
  const auto found = std::ranges::find(snapshot.topics, name, &TopicInfo::name);
  return found == snapshot.topics.end() ? nullptr : &*found;
}

TEST(Discovery, ListsProcessesTopicsTypesAndQos) {
  DdsTransport watcher(test_parameters("watcher"));
  std::optional<DdsTransport> robot(test_parameters("robot"));
  msgs::Qos qos = msgs::latched_qos();
  qos.liveliness_lease = Duration::milliseconds(300);
  qos.deadline = Duration::milliseconds(500);
  auto writer = robot->make_writer("plan", string_type(), qos);
  auto reader = robot->make_reader("image", image_type(), msgs::sensor_stream_qos(),
                                   [](const graph::MessagePtr&) {});
  ASSERT_TRUE(eventually([&] {
    const auto snapshot = watcher.discovery();
    return find_topic(snapshot, "plan") != nullptr && find_topic(snapshot, "image") != nullptr &&
           find_process(snapshot, "robot") != nullptr;
  }));
  const auto snapshot = watcher.discovery();
  const ProcessInfo& process = *find_process(snapshot, "robot");
  EXPECT_EQ(process.pid, getpid());
  EXPECT_FALSE(process.host.empty());
  EXPECT_FALSE(process.own);
  EXPECT_TRUE(find_process(snapshot, "watcher")->own);

  const TopicInfo& plan = *find_topic(snapshot, "plan");
  EXPECT_EQ(plan.type_names, std::vector<std::string>{std::string(string_type().dds_name)});
  ASSERT_EQ(plan.writers.size(), 1U);
  EXPECT_TRUE(plan.readers.empty());
  EXPECT_EQ(plan.writers.front().process, process.guid);
  EXPECT_FALSE(plan.writers.front().keyed);
  EXPECT_EQ(plan.writers.front().qos.durability, msgs::Durability::kTransientLocal);
  EXPECT_EQ(plan.writers.front().qos.reliability, msgs::Reliability::kReliable);
  EXPECT_NEAR(plan.writers.front().qos.liveliness_lease.to_seconds(), 0.3, 1e-6);
  EXPECT_NEAR(plan.writers.front().qos.deadline.to_seconds(), 0.5, 1e-6);
  const TopicInfo& image = *find_topic(snapshot, "image");
  ASSERT_EQ(image.readers.size(), 1U);
  EXPECT_EQ(image.readers.front().qos.deadline, Duration());

  const std::uint64_t before = watcher.discovery_version();
  writer.reset();
  EXPECT_TRUE(eventually([&] { return find_topic(watcher.discovery(), "plan") == nullptr; }));
  EXPECT_GT(watcher.discovery_version(), before);
  reader.reset();
  robot.reset();
  EXPECT_TRUE(eventually([&] { return find_process(watcher.discovery(), "robot") == nullptr; }));
  EXPECT_EQ(find_topic(watcher.discovery(), "image"), nullptr);
}

TEST(Discovery, ListsTheEndpointsOfTheOwnProcess) {
  DdsTransport transport(test_parameters("alone"));
  const auto writer = transport.make_writer("plan", string_type(), msgs::latched_qos());
  ASSERT_TRUE(eventually([&] { return find_topic(transport.discovery(), "plan") != nullptr; }));
  const auto snapshot = transport.discovery();
  ASSERT_EQ(find_topic(snapshot, "plan")->writers.size(), 1U);
  EXPECT_TRUE(find_topic(snapshot, "plan")->writers.front().own);
  EXPECT_EQ(find_topic(snapshot, "plan")->writers.front().process,
            find_process(snapshot, "alone")->guid);
}

TEST(Discovery, StaticPeersFindEachOther) {
  auto parameters = test_parameters("a", {"udp"});
  parameters.discovery = "static_peers";
  parameters.peers = {"127.0.0.1"};
  DdsTransport a(parameters);
  parameters.process_name = "b";
  DdsTransport b(parameters);
  EXPECT_TRUE(eventually([&] { return find_process(a.discovery(), "b") != nullptr; }));
  EXPECT_TRUE(eventually([&] { return find_process(b.discovery(), "a") != nullptr; }));
}

TEST(Discovery, StaticPeersOfOneHostFindEachOtherUnlisted) {
  auto parameters = test_parameters("a");
  parameters.discovery = "static_peers";
  parameters.peers = {"127.0.0.1:9"};  // no process listens there
  DdsTransport a(parameters);
  parameters.process_name = "b";
  DdsTransport b(parameters);
  EXPECT_TRUE(eventually([&] { return find_process(a.discovery(), "b") != nullptr; }));
}

TEST(Discovery, ProcessesFindEachOtherByADiscoveryServer) {
  auto parameters = test_parameters("a");
  const std::string address = "127.0.0.1:" + std::to_string(20000 + getpid() % 10000);
  parameters.discovery = "discovery_server";
  parameters.peers = {address};
  const DiscoveryServer server(parameters.domain_id, address);
  DdsTransport a(parameters);
  parameters.process_name = "b";
  DdsTransport b(parameters);
  parameters.process_name = "watcher";
  DdsTransport watcher(parameters);
  StringInbox inbox;
  const auto reader = b.make_reader("text", string_type(), msgs::latched_qos(), inbox.handler());
  const auto writer = a.make_writer("text", string_type(), msgs::latched_qos());
  writer->write(make_string("by the server"));
  EXPECT_TRUE(inbox.wait_for(1));
  // A process without an endpoint of a topic also knows the topic.
  EXPECT_TRUE(eventually([&] { return find_topic(watcher.discovery(), "text") != nullptr; }));
}

TEST(Discovery, ADiscoveryServerRefusesBadAddresses) {
  EXPECT_THROW(DiscoveryServer(233, "127.0.0.1"), ConfigError);
  EXPECT_THROW(DiscoveryServer(0, "localhost"), ConfigError);
  EXPECT_THROW(DiscoveryServer(0, "127.0.0.1", 256), ConfigError);
}

TEST(Discovery, DomainsAreSeparate) {
  auto parameters = test_parameters("here");
  DdsTransport here(parameters);
  DdsTransport beside(test_parameters("beside"));
  parameters.domain_id = parameters.domain_id == 100 ? 101 : parameters.domain_id - 1;
  parameters.process_name = "elsewhere";
  DdsTransport elsewhere(parameters);
  ASSERT_TRUE(eventually([&] { return find_process(here.discovery(), "beside") != nullptr; }));
  EXPECT_EQ(find_process(here.discovery(), "elsewhere"), nullptr);
}

}  // namespace
}  // namespace furrow::dds
