#include "send_queue.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <optional>
#include <vector>

namespace furrow::dds {
namespace {

using graph::MessagePtr;

constexpr std::size_t kThreshold = 100;
constexpr std::chrono::seconds kPatience{5};

struct Packet {
  int number = 0;
  std::size_t size = 1;
};

MessagePtr packet(int number, std::size_t size = 1) {
  return std::make_shared<Packet>(Packet{number, size});
}

/// Records the sent packets. While the gate is closed, send() waits.
class GatedSink final : public MessageSink {
 public:
  std::size_t size(const MessagePtr& message) override { return get(message).size; }
  bool send(const MessagePtr& message, std::size_t) override {
    std::unique_lock lock(mutex_);
    ++entered_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return open_; });
    sent_.push_back(get(message).number);
    changed_.notify_all();
    return get(message).number >= 0;
  }
  void set_open(bool open) {
    const std::lock_guard lock(mutex_);
    open_ = open;
    changed_.notify_all();
  }
  [[nodiscard]] bool wait_entered(int count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return entered_ >= count; });
  }
  [[nodiscard]] std::vector<int> sent() const {
    const std::lock_guard lock(mutex_);
    return sent_;
  }

 private:
  static const Packet& get(const MessagePtr& message) {
    return *static_cast<const Packet*>(message.get());
  }
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = true;
  int entered_ = 0;
  std::vector<int> sent_;
};

/// 0, 1, ... below `count`.
std::vector<int> numbers(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

bool idle(SendQueue& queue) {
  return queue.wait_idle(std::chrono::steady_clock::now() + kPatience);
}

TEST(SendQueue, SendsInOrderAndCounts) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 1000);
  const std::vector<int> expected = numbers(500);
  for (const int number : expected) {
    queue.push(packet(number, 3));
  }
  ASSERT_TRUE(idle(queue));
  EXPECT_EQ(sink.sent(), expected);
  EXPECT_EQ(queue.counters().messages, 500U);
  EXPECT_EQ(queue.counters().bytes, 1500U);
  EXPECT_EQ(queue.counters().dropped, 0U);
}

TEST(SendQueue, DropsTheOldestMessageWhenFull) {
  Sender sender(kThreshold);
  GatedSink sink;
  sink.set_open(false);
  SendQueue queue(sender, sink, 3);
  queue.push(packet(1));
  ASSERT_TRUE(sink.wait_entered(1));
  for (int number = 2; number <= 6; ++number) {
    queue.push(packet(number));
  }
  sink.set_open(true);
  ASSERT_TRUE(idle(queue));
  EXPECT_EQ(sink.sent(), (std::vector<int>{1, 4, 5, 6}));
  EXPECT_EQ(queue.counters().dropped, 2U);
  EXPECT_EQ(queue.counters().messages, 4U);
}

TEST(SendQueue, ALargeMessageDoesNotDelayAnotherTopic) {
  Sender sender(kThreshold);
  GatedSink images;
  GatedSink commands;
  images.set_open(false);
  SendQueue image_queue(sender, images, 5);
  SendQueue command_queue(sender, commands, 5);
  image_queue.push(packet(1, kThreshold + 1));
  ASSERT_TRUE(images.wait_entered(1));
  command_queue.push(packet(7));
  EXPECT_TRUE(idle(command_queue));
  EXPECT_EQ(commands.sent(), std::vector<int>{7});
  EXPECT_TRUE(images.sent().empty());
  images.set_open(true);
  EXPECT_TRUE(idle(image_queue));
}

TEST(SendQueue, KeepsTheOrderOfSmallAndLargeMessages) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 300);
  const std::vector<int> expected = numbers(300);
  for (const int number : expected) {
    queue.push(packet(number, number % 7 == 3 ? 2 * kThreshold : 1));
  }
  ASSERT_TRUE(idle(queue));
  EXPECT_EQ(sink.sent(), expected);
}

TEST(SendQueue, CountsMessagesThatCannotBeSent) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 3);
  queue.push(packet(-1));
  ASSERT_TRUE(idle(queue));
  queue.push(packet(1));
  ASSERT_TRUE(idle(queue));
  EXPECT_EQ(queue.counters().dropped, 1U);
  EXPECT_EQ(queue.counters().messages, 1U);
}

TEST(SendQueue, WaitIdleGivesUpAtItsDeadline) {
  Sender sender(kThreshold);
  GatedSink sink;
  sink.set_open(false);
  SendQueue queue(sender, sink, 3);
  queue.push(packet(1));
  EXPECT_FALSE(queue.wait_idle(std::chrono::steady_clock::now() + std::chrono::milliseconds(5)));
  sink.set_open(true);
  EXPECT_TRUE(idle(queue));
}

TEST(SendQueue, FreesWaitingMessagesAtDestruction) {
  Sender sender(kThreshold);
  GatedSink sink;
  sink.set_open(false);
  std::weak_ptr<const void> waiting;
  {
    auto queue = std::make_optional<SendQueue>(sender, sink, 3U);
    queue->push(packet(1));
    ASSERT_TRUE(sink.wait_entered(1));
    const MessagePtr second = packet(2);
    waiting = second;
    queue->push(second);
    sink.set_open(true);
  }
  EXPECT_TRUE(waiting.expired());
}

}  // namespace
}  // namespace furrow::dds
