#include "../src/outbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace furrow::graph {
namespace {

class NotingWriter final : public TransportWriter {
 public:
  [[nodiscard]] bool has_readers() const override { return true; }
  void write(MessagePtr) override { ADD_FAILURE() << "wakes a thread"; }
  void enqueue(MessagePtr message) override {
    numbers.push_back(*static_cast<const int*>(message.get()));
  }
  [[nodiscard]] TransportCounters counters() const override { return {}; }
  std::vector<int> numbers;
};

class OutboxTest : public testing::Test {
 protected:
  OutboxTest() {
    auto writer = std::make_unique<NotingWriter>();
    writer_ = writer.get();
    route_.writer = std::move(writer);
  }
  void put(int number) { outbox_.put(route_, std::make_shared<const int>(number)); }

  Route route_;
  NotingWriter* writer_;
  Outbox outbox_;
};

TEST_F(OutboxTest, KeepsMessagesInOrderUntilTheyAreHandedOver) {
  EXPECT_TRUE(outbox_.empty());
  put(1);
  put(2);
  EXPECT_FALSE(outbox_.empty());
  EXPECT_TRUE(writer_->numbers.empty());
  outbox_.hand_over();
  EXPECT_TRUE(outbox_.empty());
  EXPECT_EQ(writer_->numbers, (std::vector{1, 2}));
  outbox_.hand_over();
  EXPECT_EQ(writer_->numbers.size(), 2U);
}

TEST_F(OutboxTest, IsBounded) {
  constexpr int kMany = 1000;
  for (int i = 0; i < kMany; ++i) put(i);
  EXPECT_GT(writer_->numbers.size(), kMany - 100U);
  outbox_.hand_over();
  EXPECT_EQ(writer_->numbers.size(), static_cast<std::size_t>(kMany));
  EXPECT_TRUE(std::ranges::is_sorted(writer_->numbers));
}

TEST_F(OutboxTest, OrderHoldsWhoeverHandsOver) {
  constexpr int kMany = 5000;
  std::atomic<bool> stop = false;
  std::vector<std::thread> others;
  others.reserve(2);
  for (int i = 0; i < 2; ++i) {
    others.emplace_back([&] {
      while (!stop) outbox_.hand_over();
    });
  }
  for (int i = 0; i < kMany; ++i) put(i);
  stop = true;
  for (std::thread& other : others) other.join();
  outbox_.hand_over();
  EXPECT_EQ(writer_->numbers.size(), static_cast<std::size_t>(kMany));
  EXPECT_TRUE(std::ranges::is_sorted(writer_->numbers));
}

}  // namespace
}  // namespace furrow::graph
