#include "furrow_components/frame_pairing.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace furrow::components {
namespace {

using Pairing = FramePairing<std::string>;

constexpr Duration kTolerance = Duration::milliseconds(20);
constexpr Duration kPatience = Duration::milliseconds(100);

Time at_ms(std::int64_t ms) {
  return Time() + Duration::milliseconds(ms);
}
Pairing::Pointer image(const std::string& name) {
  return std::make_shared<const std::string>(name);
}

class FramePairingTest : public testing::Test {
 protected:
  void colour(std::int64_t stamp_ms, std::int64_t arrival_ms) {
    pairing_.add_colour(at_ms(stamp_ms), at_ms(arrival_ms), image(std::to_string(stamp_ms)));
  }
  void depth(std::int64_t stamp_ms, std::int64_t arrival_ms) {
    pairing_.add_depth(at_ms(stamp_ms), at_ms(arrival_ms), image(std::to_string(stamp_ms)));
  }
  /// What is settled, as "colour+depth" or "colour" for one without depth.
  std::vector<std::string> take(std::int64_t now_ms) {
    std::vector<std::string> taken;
    while (const auto frame = pairing_.next(at_ms(now_ms))) {
      taken.push_back(*frame->colour + (frame->depth ? "+" + *frame->depth : ""));
    }
    return taken;
  }

  using Names = std::vector<std::string>;
  Pairing pairing_{kTolerance, kPatience};
};

TEST_F(FramePairingTest, EqualStampsPairInEitherOrder) {
  colour(0, 1);
  EXPECT_EQ(take(1), Names());
  depth(0, 2);
  EXPECT_EQ(take(2), Names({"0+0"}));
  depth(100, 101);
  EXPECT_EQ(take(101), Names());
  colour(100, 102);
  EXPECT_EQ(take(102), Names({"100+100"}));
}

TEST_F(FramePairingTest, StampsThatDifferPairWithinTheTolerance) {
  colour(0, 1);
  depth(3, 5);
  EXPECT_EQ(take(5), Names({"0+3"}));
  depth(80, 81);  // 20 ms before the next colour image: still within
  colour(100, 101);
  EXPECT_EQ(take(101), Names({"100+80"}));
  depth(179, 180);
  colour(200, 201);
  EXPECT_EQ(take(201), Names());
}

TEST_F(FramePairingTest, TheNearestOfSeveralIsTaken) {
  depth(-15, 1);
  depth(4, 2);
  depth(18, 3);
  colour(0, 4);
  EXPECT_EQ(take(4), Names({"0+4"}));
  colour(20, 5);  // what is younger than the depth that was taken is kept
  EXPECT_EQ(take(5), Names({"20+18"}));
}

TEST_F(FramePairingTest, ADepthServesOneImage) {
  depth(0, 0);
  colour(0, 1);
  EXPECT_EQ(take(1), Names({"0+0"}));
  colour(10, 2);
  EXPECT_EQ(take(2), Names());
}

TEST_F(FramePairingTest, AnImageWithoutDepthIsHandedOutAfterItsPatience) {
  colour(0, 7);
  EXPECT_EQ(take(106), Names());
  EXPECT_EQ(take(107), Names({"0"}));
}

TEST_F(FramePairingTest, ADelayedDepthPairsWithTheOlderImage) {
  colour(0, 1);
  colour(50, 51);
  depth(0, 60);
  EXPECT_EQ(take(60), Names({"0+0"}));
  depth(50, 110);
  EXPECT_EQ(take(110), Names({"50+50"}));
}

TEST_F(FramePairingTest, WhatWaitsIsBounded) {
  for (int i = 0; i <= static_cast<int>(Pairing::kLimit); ++i) colour(i, 0);
  EXPECT_EQ(take(0), Names({"0"}));
  for (int i = 0; i < 100; ++i) depth(1000 + i * 100, 0);
  colour(1000, 1);  // its depth was pushed out
  EXPECT_EQ(take(1), Names({"1"}));
}

TEST_F(FramePairingTest, TheOffsetIsThatOfTheStamps) {
  colour(10, 10);
  depth(7, 11);
  const auto frame = pairing_.next(at_ms(11));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->offset, Duration::milliseconds(-3));
}

}  // namespace
}  // namespace furrow::components
