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

/// The surface under construction: a block with margins for objects that reach into it from beside.
/// Heights in mm. Row i lies at x = (first_x + i) texels, column j at y = (first_y + j) texels.
struct GroundRegion {
  int first_x = 0;
  int first_y = 0;
  int rows = 0;
  int columns = 0;
  int block_row = 0;  ///< first row and column of the block
  int block_column = 0;
  std::vector<float> relief_mm;  ///< height above the smooth ground
  std::vector<float> base_mm;    ///< height of the smooth ground
  std::vector<float> value;      ///< brightness of the material
  std::vector<float> tint;       ///< from -1 (greyer) to 1 (redder)
  std::vector<Material> material;
  std::vector<float> sun;  ///< share of the sunlight that arrives
  std::vector<float> sky;  ///< share of the sky that is visible

  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Sets region.sun and region.sky: shadows of the relief and of `casters`, and the light of the sky
/// that hollows and leaves keep off. `to_sun` is a unit vector in F.
void cast_shadows(GroundRegion& region, const std::vector<ShadowTriangle>& casters,
                  const Eigen::Vector3f& to_sun, double texel_m);

}  // namespace furrow::simulation
