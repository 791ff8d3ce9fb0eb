// The seam to the middleware, with a transport that only notes what it is asked to do.

#include <map>

#include "fixtures.hpp"
#include "furrow_graph/runtime.hpp"

namespace furrow::graph {
namespace {

using test::spec;

class NotingTransport final : public Transport {
 public:
  struct Writer final : WireWriter {
    Writer(NotingTransport& noting, std::string name) : owner(noting), topic(std::move(name)) {}
    [[nodiscard]] bool has_readers() const override { return owner.outside_readers; }
    void write(MessagePtr message) override { owner.written[topic].push_back(std::move(message)); }
    [[nodiscard]] WireCounters counters() const override { return {}; }
    NotingTransport& owner;
    std::string topic;
  };
  struct Reader final : WireReader {
    [[nodiscard]] WireCounters counters() const override { return {}; }
    [[nodiscard]] int writers() const override { return 0; }
  };

  std::unique_ptr<WireWriter> make_writer(const std::string& topic, const msgs::MessageType&,
                                          const msgs::Qos&) override {
    return std::make_unique<Writer>(*this, topic);
  }
  std::unique_ptr<WireReader> make_reader(const std::string& topic, const msgs::MessageType&,
                                          const msgs::Qos&,
                                          std::function<void(MessagePtr)> on_message) override {
    readers[topic] = std::move(on_message);
    return std::make_unique<Reader>();
  }

  bool outside_readers = false;
  std::map<std::string, std::vector<MessagePtr>> written;
  std::map<std::string, std::function<void(MessagePtr)>> readers;
};

GraphSpec chain() {
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay"), spec("sink", "sink")};
  return graph;
}

void run_three_plans(NotingTransport& transport, std::vector<std::string> components) {
  Registry registry = test::standard_registry();
  test::add_sink(registry, [](Context& context, const furrow_msgs::msg::Plan& plan) {
    if (plan.revision() == 3) context.request_stop("enough");
  });
  Runtime runtime(chain(), registry,
                  {.clock = ClockMode::kLockstep,
                   .components = std::move(components),
                   .transport = &transport});
  for (const auto& [topic, deliver] : transport.readers) {
    for (int i = 0; i < 3; ++i) deliver(std::make_shared<const furrow_msgs::msg::Tracks>());
  }
  runtime.run();
}

TEST(Wire, NothingIsWrittenWithoutAnOutsideReader) {
  NotingTransport transport;
  run_three_plans(transport, {});
  EXPECT_TRUE(transport.written.empty());
  EXPECT_TRUE(transport.readers.empty());  // every topic is published inside
}

TEST(Wire, AnOutsideReaderGetsWhatIsPublished) {
  NotingTransport transport;
  transport.outside_readers = true;
  run_three_plans(transport, {});
  EXPECT_EQ(transport.written["tracker/tracks"].size(), 3u);
  EXPECT_EQ(transport.written["planner/plan"].size(), 3u);
}

TEST(Wire, WhatAnotherProcessPublishesIsRead) {
  NotingTransport transport;
  run_three_plans(transport, {"r", "sink"});
  ASSERT_EQ(transport.readers.size(), 1u);
  EXPECT_TRUE(transport.readers.contains("tracker/tracks"));
}

}  // namespace
}  // namespace furrow::graph
