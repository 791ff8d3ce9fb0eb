#include "furrow_log/log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <string>
#include <thread>
#include <vector>

namespace furrow::log {
namespace {

Time at(double seconds) {
  return Time::from_seconds(seconds);
}

class Memory final : public Sink {
 public:
  bool write(const Line& line) override {
    lines.push_back(line);
    return accepts;
  }
  [[nodiscard]] std::vector<std::string> texts() const {
    std::vector<std::string> list;
    for (const Line& line : lines) list.push_back(line.component + ": " + text_of(line));
    return list;
  }
  std::vector<Line> lines;
  bool accepts = true;
};

using Texts = std::vector<std::string>;

LogOptions in_order_of_time() {
  LogOptions options;
  options.order = Order::kTime;
  return options;
}

TEST(Log, EverySinkGetsEveryLineOfTheLevel) {
  for (const Order order : {Order::kArrival, Order::kTime}) {
    LogOptions options;
    options.order = order;
    options.levels.set("warn");
    options.levels.set("planner=debug");
    Log log(options);
    const auto one = std::make_shared<Memory>();
    const auto two = std::make_shared<Memory>();
    log.add(one);
    log.add(two);
    log.write(at(1.0), Level::kInfo, "tracker", "not written");
    log.write(at(1.0), Level::kWarn, "tracker", "no pose");
    log.write(at(2.0), Level::kDebug, "planner", "3 targets");
    log.flush();
    EXPECT_EQ(one->texts(), (Texts{"tracker: no pose", "planner: 3 targets"}));
    EXPECT_EQ(one->texts(), two->texts());
    EXPECT_EQ(one->lines[1].time, at(2.0));
    EXPECT_EQ(one->lines[1].level, Level::kDebug);
    EXPECT_EQ(log.counters().written, 2u);
  }
}

TEST(Log, LinesOfOneTimeDoNotDependOnTheOrderOfThreads) {
  Texts expected;
  for (int turn = 0; turn < 20; ++turn) {
    Log log(in_order_of_time());
    const auto sink = std::make_shared<Memory>();
    log.add(sink);
    for (int step = 0; step < 5; ++step) {
      std::vector<std::thread> threads;
      for (const char* component : {"c", "a", "b"}) {
        threads.emplace_back([&log, component, step] {
          log.write(at(step), Level::kInfo, component, "first");
          log.write(at(step), Level::kInfo, component, "second");
        });
      }
      for (std::thread& thread : threads) thread.join();
    }
    log.flush();
    if (turn == 0) expected = sink->texts();
    EXPECT_EQ(sink->texts(), expected);
  }
  EXPECT_EQ(Texts(expected.begin(), expected.begin() + 4),
            (Texts{"a: first", "a: second", "b: first", "b: second"}));
}

TEST(Log, SuppressedLinesAreToldWithTheirNumber) {
  Log log(in_order_of_time());
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  for (int i = 0; i <= 60; ++i) log.write(at(0.1 * i), Level::kWarn, "tracker", "no pose");
  log.flush();
  EXPECT_EQ(sink->texts(), (Texts{"tracker: no pose", "tracker: no pose (49 more of these)",
                                  "tracker: 10 more lines of: no pose"}));
  EXPECT_EQ(log.counters().suppressed, 59u);
  log.flush();
  EXPECT_EQ(sink->lines.size(), 3u) << "told once";
}

TEST(Log, FloodOfDifferentTextsIsLimitedAndCounted) {
  Log log(in_order_of_time());
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  std::string text;
  for (int i = 0; i < 200; ++i) log.write(at(1.0), Level::kInfo, "camera", text += 'x');
  log.write(at(3.0), Level::kInfo, "camera", "later");
  log.flush();
  ASSERT_EQ(sink->lines.size(), 52u);
  EXPECT_EQ(sink->texts()[50], "camera: 150 more lines suppressed");
  EXPECT_EQ(sink->texts()[51], "camera: later");
}

TEST(Log, TextBecomesOneLineOfBoundedLength) {
  Log log(in_order_of_time());
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  log.write(at(0.0), Level::kInfo, "a", "two\nlines\r\x1b[31m");
  log.write(at(0.0), Level::kInfo, "a", std::string(100'000, 'y'));
  log.flush();
  EXPECT_EQ(sink->lines[0].message, "two lines  [31m");
  EXPECT_EQ(sink->lines[1].message.size(), 2003u);
}

TEST(Log, TextOfALibraryGetsTheTimeOfTheNewestLine) {
  Log log(in_order_of_time());
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  log.write(at(7.0), Level::kInfo, "planner", "plans");
  log.write_foreign(Level::kError, "opencv", "bad image");
  log.flush();
  ASSERT_EQ(sink->lines.size(), 2u);
  EXPECT_EQ(sink->texts()[0], "opencv: bad image");
  EXPECT_EQ(sink->lines[0].time, at(7.0));
}

TEST(Log, TextOfALibraryGetsTheTimeOfTheClockWhereThereIsOne) {
  LogOptions options = in_order_of_time();
  options.now = [] { return at(9.0); };
  Log log(options);
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  log.write_foreign(Level::kError, "fastdds", "no memory");
  log.flush();
  EXPECT_EQ(sink->lines[0].time, at(9.0));
}

TEST(Log, FullQueueDropsAndCountsWithoutWaiting) {
  LogOptions options;
  options.max_lines_per_s = 1'000'000;
  Log log(options);
  /// Holds the log's thread until it is let go.
  class Gate final : public Sink {
   public:
    bool write(const Line& line) override {
      if (!entered_) entered.set_value();
      entered_ = true;
      last = line.component + ": " + line.message;
      opened.wait();
      return true;
    }
    std::promise<void> entered;
    std::promise<void> open;
    std::shared_future<void> opened = open.get_future().share();
    std::string last;

   private:
    bool entered_ = false;
  };
  const auto gate = std::make_shared<Gate>();
  log.add(gate);
  log.write(at(0.0), Level::kInfo, "a", "x");
  gate->entered.get_future().wait();
  std::string text = "x";
  for (int i = 0; i < 5000; ++i) {
    // Different in letters, as those that differ in digits are suppressed.
    std::string different;
    for (int rest = i + 1; rest > 0; rest /= 26) different += static_cast<char>('a' + rest % 26);
    log.write(at(0.0), Level::kInfo, "a", different + "-");
  }
  EXPECT_GT(log.counters().dropped, 0u);
  EXPECT_EQ(log.counters().written + log.counters().dropped, 5001u);
  gate->open.set_value();
  const std::uint64_t dropped = log.counters().dropped;
  log.flush();
  EXPECT_EQ(gate->last, "log: " + std::to_string(dropped) +
                            " lines were dropped; the queue to the disk was full");
}

TEST(Log, SinkThatIsRemovedIsNotCalled) {
  Log log;
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  log.write(at(0.0), Level::kInfo, "a", "before");
  log.remove(*sink);
  log.write(at(0.0), Level::kInfo, "a", "after");
  log.flush();
  EXPECT_EQ(sink->texts(), (Texts{"a: before"}));
}

TEST(Log, LineThatASinkCannotWriteIsCounted) {
  Log log(in_order_of_time());
  const auto sink = std::make_shared<Memory>();
  sink->accepts = false;
  log.add(sink);
  log.write(at(0.0), Level::kInfo, "a", "x");
  log.flush();
  EXPECT_EQ(log.counters().failed, 1u);
}

}  // namespace
}  // namespace furrow::log
