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

/// Notes what is sent; may be closed, so that send() waits.
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

/// From 0 on.
std::vector<int> numbers(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Every seventh is large.
MessagePtr mixed_packet(int number) {
  return packet(number, number % 7 == 3 ? 2 * kThreshold : 1);
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

TEST(SendQueue, DropsTheOldestWhenFull) {
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

TEST(SendQueue, LargeMessagesDoNotHoldUpSmallOnesOfAnotherTopic) {
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

TEST(SendQueue, KeepsTheOrderOfATopicWithSmallAndLargeMessages) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 300);
  const std::vector<int> expected = numbers(300);
  for (const int number : expected) {
    queue.push(mixed_packet(number));
  }
  ASSERT_TRUE(idle(queue));
  EXPECT_EQ(sink.sent(), expected);
}

TEST(SendQueue, AnotherThreadMaySendInItsPlace) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 5);
  EXPECT_FALSE(sender.has_waiting());
  queue.push_quietly(packet(1));
  queue.push_quietly(packet(2, kThreshold + 1));
  EXPECT_TRUE(sender.has_waiting());
  EXPECT_TRUE(sink.sent().empty());
  // The second is looked at, and sent with the large ones.
  for (int i = 0; i < 3; ++i) {
    sender.send_one();
  }
  EXPECT_EQ(sink.sent(), (std::vector<int>{1, 2}));
  EXPECT_FALSE(sender.has_waiting());
  sender.send_one();
  EXPECT_EQ(queue.counters().messages, 2U);
}

TEST(SendQueue, WhatWaitsIsSentAfterTheDelay) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 5);
  queue.push_quietly(packet(1));
  sender.wake_in(std::chrono::hours(1));
  EXPECT_TRUE(sink.sent().empty());
  // A sooner ring takes its place; a later one does not put it off.
  queue.push(packet(2));
  sender.wake_in(std::chrono::hours(1));
  ASSERT_TRUE(sink.wait_entered(2));
  EXPECT_TRUE(idle(queue));
  EXPECT_EQ(sink.sent(), (std::vector<int>{1, 2}));
}

TEST(SendQueue, KeepsTheOrderWhoeverSends) {
  Sender sender(kThreshold);
  GatedSink sink;
  SendQueue queue(sender, sink, 300);
  const std::vector<int> expected = numbers(300);
  for (const int number : expected) {
    if (number % 3 == 0) {
      queue.push(mixed_packet(number));
    } else {
      queue.push_quietly(mixed_packet(number));
      sender.send_one();
    }
  }
  ASSERT_TRUE(idle(queue));
  EXPECT_EQ(sink.sent(), expected);
}

TEST(SendQueue, CountsWhatCouldNotBeSent) {
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

TEST(SendQueue, LetsGoOfWhatWaitsWhenDestroyed) {
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
