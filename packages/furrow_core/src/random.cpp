#include "furrow_core/random.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include "furrow_core/hash.hpp"

namespace furrow {
namespace {

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15ull;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

std::uint64_t mix(std::uint64_t seed, std::uint64_t salt) {
  std::uint64_t state = seed ^ std::rotl(salt, 29);
  return splitmix64(state) ^ salt;
}

}  // namespace

Random::Random(std::uint64_t seed) {
  for (auto& word : state_) word = splitmix64(seed);
}

Random::Random(std::uint64_t seed, std::string_view stream) : Random(mix(seed, fnv1a_64(stream))) {}

Random::Random(std::uint64_t seed, std::string_view stream, std::uint64_t index)
    : Random(mix(mix(seed, fnv1a_64(stream)), index + 1)) {}

std::uint64_t Random::next() {
  const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Random::uniform() {
  return static_cast<double>(next() >> 11) * 0x1.0p-53;
}

double Random::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

std::int64_t Random::integer(std::int64_t low, std::int64_t high) {
  const auto span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
  if (span == 0) return static_cast<std::int64_t>(next());
  // Values above the last whole multiple of the span would favour the low results.
  const std::uint64_t reject_below = (0 - span) % span;
  std::uint64_t value = next();
  while (value < reject_below) value = next();
  return low + static_cast<std::int64_t>(value % span);
}

bool Random::bernoulli(double probability) {
  return uniform() < probability;
}

double Random::normal(double mean, double standard_deviation) {
  // Box and Muller 1958. The second value is dropped: keeping it would be hidden state.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return mean + standard_deviation * radius * std::cos(2.0 * std::numbers::pi * uniform());
}

double Random::exponential(double mean) {
  return -mean * std::log(1.0 - uniform());
}

std::int64_t Random::poisson(double mean) {
  // Knuth's product underflows for large means; a Poisson variable is a sum of smaller ones.
  constexpr double kBlock = 32.0;
  std::int64_t count = 0;
  while (mean > 0.0) {
    const double limit = std::exp(-std::fmin(mean, kBlock));
    for (double product = uniform(); product > limit; product *= uniform()) ++count;
    mean -= kBlock;
  }
  return count;
}

}  // namespace furrow
