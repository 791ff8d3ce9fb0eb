#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace furrow::simulation {

/// A row of a square tile; `row` is wrapped. @pre row >= 0.
[[nodiscard]] inline const float* tile_row(const std::vector<float>& tile, int size, int row) {
  return tile.data() + static_cast<std::ptrdiff_t>(row % size) * size;
}

/// A number in [-1, 1] for a lattice point.
[[nodiscard]] float lattice_value(std::uint64_t seed, std::int32_t x, std::int32_t y);
/// Smoothly interpolated lattice values; `x` and `y` in lattice steps. In [-1, 1].
[[nodiscard]] float value_noise(std::uint64_t seed, double x, double y);

struct NoiseOctave {
  int wavelength = 1;  ///< in texels; divides the tile's size
  float amplitude = 1.0f;
};

/// A square, seamless tile of summed value noise.
[[nodiscard]] std::vector<float> noise_tile(int size, const std::vector<NoiseOctave>& octaves,
                                            std::uint64_t seed);

}  // namespace furrow::simulation
