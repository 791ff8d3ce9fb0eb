#include "../src/mailbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <random>

namespace furrow::graph {
namespace {

Mail mail_of(std::size_t input, int number) {
  return {input, std::make_shared<const int>(number), Time::from_nanoseconds(number)};
}

TEST(Mailbox, QueuesMessagesOverAllInputs) {
  std::mt19937 random(7);
  Mailbox mailbox;
  std::deque<Mail> expected;
  for (int number = 0; number < 20'000; ++number) {
    // Filled and emptied in turn, several times beyond the first capacity.
    const bool filling = number / 500 % 2 == 0;
    const auto draw = random() % 10;
    if (draw == 0 && !expected.empty()) {
      const std::size_t input = expected[random() % expected.size()].input;
      const auto oldest = std::ranges::find(expected, input, &Mail::input);
      const Mail taken = mailbox.take_oldest_of(input);
      EXPECT_EQ(taken.message, oldest->message);
      EXPECT_EQ(taken.input, input);
      expected.erase(oldest);
    } else if (draw < 3 + (filling ? 0U : 4U)) {
      if (expected.empty()) continue;
      const Mail taken = mailbox.pop();
      EXPECT_EQ(taken.message, expected.front().message);
      EXPECT_EQ(taken.arrived, expected.front().arrived);
      expected.pop_front();
    } else {
      const Mail mail = mail_of(random() % 4, number);
      mailbox.push(mail);
      expected.push_back(mail);
    }
    ASSERT_EQ(mailbox.size(), expected.size());
    ASSERT_EQ(mailbox.empty(), expected.empty());
  }
}

TEST(Mailbox, KeepsNoRemovedMessage) {
  Mailbox mailbox;
  for (int i = 0; i < 3; ++i) mailbox.push(mail_of(0, i));
  const std::weak_ptr<const void> popped = mailbox.pop().message;
  EXPECT_TRUE(popped.expired());
  const std::weak_ptr<const void> taken = mailbox.take_oldest_of(0).message;
  EXPECT_TRUE(taken.expired());
}

}  // namespace
}  // namespace furrow::graph
