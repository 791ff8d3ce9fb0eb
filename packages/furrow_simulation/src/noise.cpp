#include "noise.hpp"

#include <cmath>

namespace furrow::simulation {
namespace {

float smooth(float t) {
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace

float lattice_value(std::uint64_t seed, std::int32_t x, std::int32_t y) {
  std::uint64_t h = seed ^ (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
                            static_cast<std::uint32_t>(y));
  h ^= h >> 31;
  h *= 0xBF58476D1CE4E5B9ull;
  h ^= h >> 29;
  h *= 0x94D049BB133111EBull;
  h ^= h >> 32;
  return static_cast<float>(h >> 40) * (2.0f / 16777215.0f) - 1.0f;
}

float value_noise(std::uint64_t seed, double x, double y) {
  const double floor_x = std::floor(x);
  const double floor_y = std::floor(y);
  const auto ix = static_cast<std::int32_t>(floor_x);
  const auto iy = static_cast<std::int32_t>(floor_y);
  const float tx = smooth(static_cast<float>(x - floor_x));
  const float ty = smooth(static_cast<float>(y - floor_y));
  const float a = lattice_value(seed, ix, iy);
  const float b = lattice_value(seed, ix + 1, iy);
  const float c = lattice_value(seed, ix, iy + 1);
  const float d = lattice_value(seed, ix + 1, iy + 1);
  const float low = a + (b - a) * tx;
  const float high = c + (d - c) * tx;
  return low + (high - low) * ty;
}

std::vector<float> noise_tile(int size, const std::vector<NoiseOctave>& octaves,
                              std::uint64_t seed) {
  std::vector<float> tile(static_cast<std::size_t>(size) * size, 0.0f);
  for (std::size_t o = 0; o < octaves.size(); ++o) {
    const int wavelength = octaves[o].wavelength;
    const int period = size / wavelength;
    std::vector<float> lattice(static_cast<std::size_t>(period) * period);
    for (int i = 0; i < period * period; ++i) {
      lattice[i] = octaves[o].amplitude * lattice_value(seed + o, i / period, i % period);
    }
    std::vector<float> weight(static_cast<std::size_t>(wavelength));
    for (int i = 0; i < wavelength; ++i) {
      weight[i] = smooth(static_cast<float>(i) / static_cast<float>(wavelength));
    }
    for (int y = 0; y < size; ++y) {
      const float ty = weight[y % wavelength];
      const float* row = tile_row(lattice, period, y / wavelength);
      const float* next = tile_row(lattice, period, y / wavelength + 1);
      for (int cell = 0; cell < period; ++cell) {
        const int right = (cell + 1) % period;
        const float left_value = row[cell] + (next[cell] - row[cell]) * ty;
        const float right_value = row[right] + (next[right] - row[right]) * ty;
        float* out = tile.data() + static_cast<std::ptrdiff_t>(y) * size +
                     static_cast<std::ptrdiff_t>(cell) * wavelength;
        for (int i = 0; i < wavelength; ++i) {
          out[i] += left_value + (right_value - left_value) * weight[i];
        }
      }
    }
  }
  return tile;
}

}  // namespace furrow::simulation
