#include "alarm.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace furrow::dds {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

TEST(Alarm, RingsNotBeforeItsTime) {
  Alarm alarm;
  const auto begin = Clock::now();
  alarm.ring_in(milliseconds(20));
  alarm.wait();
  EXPECT_GE(Clock::now() - begin, milliseconds(20));
}

TEST(Alarm, KeepsARingForWhoWaitsLater) {
  Alarm alarm;
  alarm.ring_in(milliseconds(0));
  std::this_thread::yield();
  alarm.wait();
}

TEST(Alarm, AnEarlierRingTakesThePlaceOfALaterOne) {
  Alarm alarm;
  const auto begin = Clock::now();
  alarm.ring_in(std::chrono::hours(1));
  alarm.ring_in(milliseconds(1));
  alarm.wait();
  EXPECT_LT(Clock::now() - begin, std::chrono::minutes(1));
}

TEST(Alarm, WakesAThreadThatWaits) {
  Alarm alarm;
  std::thread waiting([&] { alarm.wait(); });
  alarm.ring_in(milliseconds(0));
  waiting.join();
}

}  // namespace
}  // namespace furrow::dds
