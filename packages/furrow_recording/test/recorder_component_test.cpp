#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "../src/topic_list.hpp"
#include "furrow_core/file.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_recording/mcap_reader.hpp"

namespace furrow::recording {
namespace {

using graph::Context;
using msgs::topics::PlannerHeartbeat;

graph::ComponentSpec spec(const std::string& name, const std::string& class_name) {
  return {.name = name, .group = name, .class_name = class_name, .where = {"graph.yaml", 1}};
}

class RecorderComponentTest : public testing::Test {
 protected:
  RecorderComponentTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    file_ = std::filesystem::path(testing::TempDir()) / "furrow_recording" / test->name();
    std::filesystem::create_directories(file_.parent_path());
    std::filesystem::remove(recorded());
    registry_.add_search_folder(FURROW_COMPONENT_FOLDER);
    graph_.components = {spec("recorder", "recorder")};
    graph_.components[0].parameters = {{.name = "file", .value = file_.string()},
                                       {.name = "min_free_mb", .value = 0.0}};
  }

  /// Adds a component that publishes heartbeats.
  void add_source(std::function<void(Context&, const graph::Output<PlannerHeartbeat>&)> tick) {
    graph::ComponentClass source{.name = "source"};
    source.description.output<PlannerHeartbeat>();
    source.make = [tick = std::move(tick)](Context& context) {
      auto out = context.output<PlannerHeartbeat>();
      context.every(Duration::milliseconds(1), [&context, out, tick](Time) { tick(context, out); });
      return std::make_unique<graph::Component>();
    };
    registry_.add(std::move(source));
    graph_.components.push_back(spec("source", "source"));
  }

  /// Until a component stops it; the file is closed then.
  std::string run(const graph::RuntimeOptions& options) {
    runtime_ = std::make_unique<graph::Runtime>(graph_, registry_, options);
    const graph::RunResult result = runtime_->run();
    runtime_.reset();
    return result.reason;
  }

  [[nodiscard]] std::filesystem::path recorded() const { return file_.string() + "_0.mcap"; }

  /// When each heartbeat came, by the file.
  [[nodiscard]] std::vector<Time> heartbeats() const {
    std::vector<Time> times;
    auto source = mcap::open_file(recorded());
    EXPECT_TRUE(source.ok());
    const auto reader = mcap::Reader::open(std::move(source).value());
    EXPECT_TRUE(reader.ok());
    auto cursor = reader->messages();
    while (true) {
      const auto next = cursor.next();
      EXPECT_TRUE(next.ok());
      if (!next->has_value()) return times;
      const auto* channel = reader->channel((*next)->channel_id);
      if (channel->topic == "/planner/heartbeat") times.push_back((*next)->log_time);
    }
  }

  std::filesystem::path file_;
  graph::Registry registry_;
  graph::GraphSpec graph_;
  std::unique_ptr<graph::Runtime> runtime_;
};

TEST(TopicList, IsTheTableOfTopics) {
  std::vector<std::string_view> listed;
  AllTopics::for_each([&]<class T>() { listed.push_back(T::topic().name); });
  std::vector<std::string_view> table;
  for (const msgs::Topic& topic : msgs::all_topics()) table.push_back(topic.name);
  EXPECT_EQ(listed, table);
}

TEST_F(RecorderComponentTest, RecordsEveryMessageOfATopicOfWhichOthersWantTheNewest) {
  ASSERT_EQ(PlannerHeartbeat::topic().qos.depth, 1);
  constexpr int kMessages = 60;
  int ticks = 0;
  add_source([&](Context& context, const auto& out) {
    if (++ticks == 2) return context.request_stop("enough");
    for (int i = 0; i < kMessages; ++i) out.publish(PlannerHeartbeat::Message());
  });
  EXPECT_EQ(run({.clock = graph::ClockMode::kLockstep}), "enough");
  EXPECT_EQ(heartbeats(), std::vector(kMessages, Time() + Duration::milliseconds(1)));
}

TEST_F(RecorderComponentTest, SameMessagesGiveTheSameFileHoweverLongASimulatedStepTook) {
  auto& parameters = graph_.components[0].parameters;
  parameters.push_back({.name = "wait_for_disk", .value = true});
  parameters.push_back({.name = "flush_s", .value = 1.0});
  int ticks = 0;
  std::chrono::milliseconds step_takes{0};
  add_source([&](Context& context, const auto& out) {
    if (++ticks == 10) return context.request_stop("enough");
    out.publish(PlannerHeartbeat::Message());
    // As a step does that renders an image: longer than flush_s on the clock of the wall.
    if (ticks == 5) std::this_thread::sleep_for(step_takes);
  });
  const auto record = [&](std::chrono::milliseconds pause) {
    ticks = 0;
    step_takes = pause;
    std::filesystem::remove(recorded());
    EXPECT_EQ(run({.clock = graph::ClockMode::kLockstep}), "enough");
    return read_file(recorded(), 1u << 20).value();
  };
  const std::string quick = record({});
  EXPECT_TRUE(quick == record(std::chrono::milliseconds(1500)));
}

TEST_F(RecorderComponentTest, RecordsWhenAMessageCameHoweverLongItWaitedForAThread) {
  std::atomic<bool> busy = false;
  std::atomic<bool> published = false;
  Time after;
  graph::ComponentClass hog{.name = "hog"};
  hog.make = [&](Context& context) {
    context.every(Duration::milliseconds(1), [&](Time) {
      busy = true;
      published.wait(false);
    });
    return std::make_unique<graph::Component>();
  };
  registry_.add(std::move(hog));
  graph_.components.push_back(spec("hog", "hog"));
  add_source([&](Context& context, const auto& out) {
    if (busy && !published) {
      out.publish(PlannerHeartbeat::Message());
      after = context.now();
      published = true;
      published.notify_all();
    }
    const auto all = runtime_->status();
    const auto& recorder = *std::ranges::find(all, "recorder", &graph::ComponentStatus::name);
    if (recorder.callbacks > 0) context.request_stop("enough");
  });
  graph_.components.back().dedicated_thread = true;
  EXPECT_EQ(run({.clock = graph::ClockMode::kReal, .threads = 1}), "enough");
  const std::vector<Time> times = heartbeats();
  ASSERT_EQ(times.size(), 1U);
  EXPECT_LE(times[0], after);
}

}  // namespace
}  // namespace furrow::recording
