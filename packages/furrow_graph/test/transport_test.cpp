// The graph with a transport that records its calls.

#include <map>

#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/diagnostic_msgs.h"

namespace furrow::graph {
namespace {

using test::spec;

class RecordingTransport final : public Transport {
 public:
  struct Writer final : TransportWriter {
    Writer(RecordingTransport& recording, std::string name)
        : owner(recording), topic(std::move(name)) {}
    [[nodiscard]] bool has_readers() const override { return owner.external_subscribers; }
    void write(MessagePtr message) override { owner.written[topic].push_back(std::move(message)); }
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    RecordingTransport& owner;
    std::string topic;
  };
  struct Reader final : TransportReader {
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    [[nodiscard]] int writers() const override { return 0; }
  };

  std::unique_ptr<TransportWriter> make_writer(const std::string& topic, const msgs::MessageType&,
                                               const msgs::Qos&) override {
    return std::make_unique<Writer>(*this, topic);
  }
  std::unique_ptr<TransportReader> make_reader(
      const std::string& topic, const msgs::MessageType&, const msgs::Qos&,
      std::function<void(MessagePtr)> on_message) override {
    readers[topic] = std::move(on_message);
    return std::make_unique<Reader>();
  }

  bool external_subscribers = false;
  std::map<std::string, std::vector<MessagePtr>> written;
  std::map<std::string, std::function<void(MessagePtr)>> readers;
};

GraphSpec source_relay_sink() {
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay"), spec("sink", "sink")};
  return graph;
}

void run_three_plans(RecordingTransport& transport, std::vector<std::string> components) {
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context& context, const furrow_msgs::msg::Plan& plan) {
    if (plan.revision() == 3) context.request_stop("enough");
  });
  Runtime runtime(source_relay_sink(), registry,
                  {.clock = ClockMode::kLockstep,
                   .components = std::move(components),
                   .transport = &transport});
  for (const auto& [topic, deliver] : transport.readers) {
    for (int i = 0; i < 3; ++i) deliver(std::make_shared<const furrow_msgs::msg::Tracks>());
  }
  runtime.run();
}

TEST(Transport, NothingIsWrittenWithoutAnExternalSubscriber) {
  RecordingTransport transport;
  run_three_plans(transport, {});
  EXPECT_TRUE(transport.written.empty());
  EXPECT_TRUE(transport.readers.empty());  // this process publishes every topic
}

TEST(Transport, AnExternalSubscriberGetsEveryMessage) {
  RecordingTransport transport;
  transport.external_subscribers = true;
  run_three_plans(transport, {});
  EXPECT_EQ(transport.written["tracker/tracks"].size(), 3u);
  EXPECT_EQ(transport.written["planner/plan"].size(), 3u);
}

TEST(Transport, ReadsTopicsOfOtherProcesses) {
  RecordingTransport transport;
  run_three_plans(transport, {"r", "sink"});
  ASSERT_EQ(transport.readers.size(), 1u);
  EXPECT_TRUE(transport.readers.contains("tracker/tracks"));
}

/// The messages on `diagnostics` in 2.5 s of simulated time, in CDR form.
std::vector<std::vector<std::byte>> diagnostics(int threads) {
  RecordingTransport transport;
  transport.external_subscribers = true;
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
  for (const MessagePtr& message : transport.written["diagnostics"]) {
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
