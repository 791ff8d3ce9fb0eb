#include "furrow_core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace furrow {
namespace {

TEST(Random, FirstValuesAreThoseOfTheReference) {
  // The reference C code of splitmix64 (Vigna 2015), run by hand for seed 0, gives these as the
  // state; the first output is rotl(s1 * 5, 7) * 9.
  const std::uint64_t s1 = 0x6E789E6AA1B965F4ull;
  const std::uint64_t product = s1 * 5;
  EXPECT_EQ(Random(0).next(), ((product << 7) | (product >> 57)) * 9);
}

TEST(Random, SameSeedSameValues) {
  Random a(42, "camera");
  Random b(42, "camera");
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(Random, StreamsDiffer) {
  EXPECT_NE(Random(42, "camera").next(), Random(42, "wheels").next());
  EXPECT_NE(Random(42, "plant", 0).next(), Random(42, "plant", 1).next());
  EXPECT_NE(Random(42, "plant", 0).next(), Random(42, "plant").next());
}

TEST(Random, IntegerCoversItsRangeEvenly) {
  Random random(1);
  std::vector<int> counts(5);
  const int draws = 50000;
  for (int i = 0; i < draws; ++i) ++counts.at(static_cast<std::size_t>(random.integer(-2, 2) + 2));
  for (const int count : counts) EXPECT_NEAR(count, draws / 5, 5 * std::sqrt(draws * 0.16));
}

TEST(Random, PoissonHasItsMeanAndVariance) {
  for (const double mean : {0.3, 8.2, 120.0}) {
    Random random(3, "poisson");
    const int draws = 20000;
    double sum = 0, sum_of_squares = 0;
    for (int i = 0; i < draws; ++i) {
      const auto x = static_cast<double>(random.poisson(mean));
      sum += x;
      sum_of_squares += x * x;
    }
    const double sample_mean = sum / draws;
    EXPECT_NEAR(sample_mean, mean, 5 * std::sqrt(mean / draws));
    EXPECT_NEAR(sum_of_squares / draws - sample_mean * sample_mean, mean, 0.06 * mean);
  }
}

TEST(Random, NormalHasItsMoments) {
  Random random(5);
  const int draws = 40000;
  double sum = 0, sum_of_squares = 0;
  for (int i = 0; i < draws; ++i) {
    const double x = random.normal(2.0, 3.0);
    sum += x;
    sum_of_squares += x * x;
  }
  const double mean = sum / draws;
  EXPECT_NEAR(mean, 2.0, 5 * 3.0 / std::sqrt(draws));
  EXPECT_NEAR(std::sqrt(sum_of_squares / draws - mean * mean), 3.0, 0.06);
}

}  // namespace
}  // namespace furrow
