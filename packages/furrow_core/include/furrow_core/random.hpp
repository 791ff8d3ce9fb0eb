#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace furrow {

/// Seeded random numbers that are the same on every standard library: xoshiro256** (Blackman and
/// Vigna 2021), seeded by splitmix64. Give each use its own stream: then one more draw in
/// one place changes no other. Not thread-safe. Copyable.
class Random {
 public:
  explicit Random(std::uint64_t seed);
  /// An independent stream of the same seed, identified by its name.
  Random(std::uint64_t seed, std::string_view stream);
  /// An independent stream of the same seed and name, identified by `index` (a plant, a frame).
  Random(std::uint64_t seed, std::string_view stream, std::uint64_t index);

  [[nodiscard]] std::uint64_t next();
  /// In [0, 1).
  [[nodiscard]] double uniform();
  /// In [low, high). @pre low <= high.
  [[nodiscard]] double uniform(double low, double high);
  /// In [low, high], both included. @pre low <= high.
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high);
  [[nodiscard]] bool bernoulli(double probability);
  [[nodiscard]] double normal(double mean, double standard_deviation);
  [[nodiscard]] double exponential(double mean);
  /// @pre mean >= 0. Exact for any mean (sums of exponential waiting times, in blocks).
  [[nodiscard]] std::int64_t poisson(double mean);

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace furrow
