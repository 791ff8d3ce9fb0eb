#pragma once

#include <cstdint>
#include <vector>

#include "furrow_simulation/ground.hpp"

namespace furrow::simulation {

// Sizes of the noise tiles, in texels. Layers of both meet again after 6720 texels.
inline constexpr int kFineTileSize = 480;
inline constexpr int kCoarseTileSize = 448;
// Makes texel coordinates positive before they are wrapped to a tile; a multiple of both sizes.
inline constexpr int kTexelLift = kFineTileSize * kCoarseTileSize * 64;

enum class Material : std::uint8_t { kSoil, kStone, kStraw };

/// The surface under construction: a block with margins, as wide as what stands beside the block
/// reaches into it. Heights in mm; row i lies at x = (first_x + i) texels, column j at
/// y = (first_y + j).
struct Ground::Region {
  int first_x = 0;
  int first_y = 0;
  int rows = 0;
  int columns = 0;
  int block_row = 0;  ///< where the block begins
  int block_column = 0;
  std::vector<float> relief_mm;  ///< what lies on the smooth ground
  std::vector<float> base_mm;    ///< the smooth ground
  std::vector<float> value;      ///< brightness of the material
  std::vector<float> tint;       ///< from -1 (greyer) to 1 (redder)
  std::vector<Material> material;
  std::vector<float> sun;  ///< share of the sun that arrives
  std::vector<float> sky;  ///< share of the sky that is seen

  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

}  // namespace furrow::simulation
