#include "furrow_simulation/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "furrow_core/error.hpp"
#include "ground_region.hpp"
#include "noise.hpp"

namespace furrow::simulation {
namespace {

// Texels around a block. The margin towards the sun is as long as the longest shadow of a clod.
constexpr int kMargin = 12;
constexpr int kSunMargin = 44;

}  // namespace

void GroundParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "soil_rgb",
           .description = "colour of the dry soil as red, green, blue of a picture",
           .min = 0.0,
           .max = 1.0},
          soil_rgb);
  const auto share = [&](const char* name, const char* description, double& value, double max) {
    v.visit({.name = name, .description = description, .min = 0.0, .max = max}, value);
  };
  share("moisture", "0 dry and light, 1 wet and dark", moisture, 1.0);
  share("moisture_patchiness", "how unevenly the soil has dried", moisture_patchiness, 1.0);
  share("color_variation", "variation of the soil's colour from place to place", color_variation,
        1.0);
  v.visit({.name = "undulation_mm",
           .unit = "mm",
           .description = "height of the smooth waves of the ground, up and down",
           .min = 0.0,
           .max = 40.0},
          undulation_mm);
  v.visit({.name = "roughness_mm",
           .unit = "mm",
           .description = "height of the finest grain",
           .min = 0.0,
           .max = 3.0},
          roughness_mm);
  share("crumb_cover", "share of the area under crumbs of 3 to 8 mm", crumb_cover, 0.9);
  share("clod_cover", "share of the area under clods", clod_cover, 0.6);
  v.visit({.name = "clod_size_mm",
           .unit = "mm",
           .description = "size of the largest clods",
           .min = 8.0,
           .max = 80.0},
          clod_size_mm);
  share("stone_cover", "share of the area under stones", stone_cover, 0.3);
  v.visit({.name = "straw_per_m2",
           .unit = "1/m2",
           .description = "pieces of straw and residue",
           .min = 0.0,
           .max = 600.0},
          straw_per_m2);
  v.visit({.name = "crack_depth_mm",
           .unit = "mm",
           .description = "depth of drying cracks; 0: none",
           .min = 0.0,
           .max = 20.0},
          crack_depth_mm);
  v.visit({.name = "ground_resolution_mm",
           .unit = "mm",
           .description = "size of the ground's texels",
           .min = 0.4,
           .max = 4.0},
          ground_resolution_mm);
}

Ground::Ground(const GroundParameters& parameters, const Light& light, std::uint64_t seed)
    : parameters_(parameters),
      light_(light),
      seed_(seed),
      texel_m_(1e-3 * parameters.ground_resolution_mm) {
  if (parameters.soil_rgb.size() != 3) {
    throw ConfigError("ground: soil_rgb needs three numbers");
  }
  for (int i = 0; i < 3; ++i) {
    const double value = parameters.soil_rgb[static_cast<std::size_t>(i)];
    if (!(value >= 0.0 && value <= 1.0)) {
      throw ConfigError("ground: soil_rgb must lie between 0 and 1");
    }
    soil_linear_[i] = static_cast<float>(value * value);
  }
  if (!(texel_m_ >= 4e-4 && texel_m_ <= 4e-3)) {
    throw ConfigError("ground: ground_resolution_mm must lie between 0.4 and 4");
  }
  fine_tile_ =
      noise_tile(kFineTileSize, {{2, 0.34f}, {4, 0.36f}, {8, 0.42f}, {20, 0.40f}}, seed ^ 0xF1);
  coarse_tile_ = noise_tile(kCoarseTileSize, {{16, 0.22f}, {32, 0.28f}, {64, 0.30f}, {112, 0.30f}},
                            seed ^ 0xC0);
}

double Ground::base_height_m(double x_F_m, double y_F_m) const {
  const double waves = 0.5 * value_noise(seed_ + 11, x_F_m / 0.9, y_F_m / 0.7) +
                       0.3 * value_noise(seed_ + 12, x_F_m / 0.37, y_F_m / 0.33) +
                       0.2 * value_noise(seed_ + 13, x_F_m / 0.17, y_F_m / 0.19);
  return 1e-3 * parameters_.undulation_mm * waves;
}

double Ground::shadow_length_m(double height_m) const {
  const Eigen::Vector3f& sun = light_.to_sun();
  const double slope = std::hypot(sun.x(), sun.y()) / sun.z();
  return height_m * slope + 0.02;
}

void Ground::make_block(std::int32_t block_x, std::int32_t block_y,
                        const std::vector<ShadowTriangle>& casters, GroundBlock& block) const {
  const Eigen::Vector3f& sun = light_.to_sun();
  const auto margin = [](bool towards_sun) { return towards_sun ? kSunMargin : kMargin; };
  GroundRegion region;
  region.block_row = margin(sun.x() < -0.02f);
  region.block_column = margin(sun.y() < -0.02f);
  region.first_x = block_x * GroundBlock::kSize - region.block_row;
  region.first_y = block_y * GroundBlock::kSize - region.block_column;
  region.rows = GroundBlock::kSize + region.block_row + margin(sun.x() > 0.02f);
  region.columns = GroundBlock::kSize + region.block_column + margin(sun.y() > 0.02f);
  const auto count = static_cast<std::size_t>(region.rows) * region.columns;
  region.relief_mm.resize(count);
  region.base_mm.resize(count);
  region.value.resize(count);
  region.tint.resize(count);
  region.material.assign(count, Material::kSoil);
  add_noise(region);
  add_smooth_ground(region);
  add_cracks(region);
  add_lumps(region);
  add_straw(region);
  cast_shadows(region, casters, sun, texel_m_);
  block.texels.resize(static_cast<std::size_t>(GroundBlock::kSize) * GroundBlock::kSize);
  shade(region, block);
}

void Ground::add_noise(GroundRegion& region) const {
  const auto roughness = static_cast<float>(parameters_.roughness_mm);
  // Crumbly soil is also uneven between its crumbs.
  const auto unevenness = static_cast<float>(1.2 + 2.5 * parameters_.clod_cover);
  for (int row = 0; row < region.rows; ++row) {
    const int x = region.first_x + row + kTexelLift;
    const float* fine = tile_row(fine_tile_, kFineTileSize, x);
    const float* coarse = tile_row(coarse_tile_, kCoarseTileSize, x);
    int fine_column = (region.first_y + kTexelLift) % kFineTileSize;
    int coarse_column = (region.first_y + kTexelLift) % kCoarseTileSize;
    // Turned by a quarter: another layer of the same tile.
    const float* turned = coarse_tile_.data() + (x / 2) % kCoarseTileSize;
    float* relief = region.relief_mm.data() + region.at(row, 0);
    float* value = region.value.data() + region.at(row, 0);
    float* tint = region.tint.data() + region.at(row, 0);
    for (int column = 0; column < region.columns; ++column) {
      const float f = fine[fine_column];
      const float c = coarse[coarse_column];
      const float t = turned[static_cast<std::ptrdiff_t>(coarse_column * 7 / 8) * kCoarseTileSize];
      relief[column] = roughness * f + unevenness * c;
      value[column] = 1.0f + 0.16f * f + 0.08f * c;
      tint[column] = t;
      if (++fine_column == kFineTileSize) fine_column = 0;
      if (++coarse_column == kCoarseTileSize) coarse_column = 0;
    }
  }
}

void Ground::add_smooth_ground(GroundRegion& region) const {
  // Computed at every eighth texel of F and interpolated, because the noise is expensive.
  constexpr int kStep = 8;
  const auto floor_step = [](int v) { return (v + kTexelLift) / kStep - kTexelLift / kStep; };
  const int gx = floor_step(region.first_x);
  const int gy = floor_step(region.first_y);
  const int nodes_x = floor_step(region.first_x + region.rows) - gx + 2;
  const int nodes_y = floor_step(region.first_y + region.columns) - gy + 2;
  std::vector<float> nodes(static_cast<std::size_t>(nodes_x) * nodes_y);
  for (int i = 0; i < nodes_x; ++i) {
    for (int j = 0; j < nodes_y; ++j) {
      nodes[static_cast<std::size_t>(i) * nodes_y + j] = static_cast<float>(
          1e3 * base_height_m((gx + i) * kStep * texel_m_, (gy + j) * kStep * texel_m_));
    }
  }
  for (int row = 0; row < region.rows; ++row) {
    const int x = region.first_x + row - gx * kStep;
    const float tx = static_cast<float>(x % kStep) / kStep;
    const float* a = nodes.data() + static_cast<std::ptrdiff_t>(x / kStep) * nodes_y;
    const float* b = a + nodes_y;
    for (int column = 0; column < region.columns; ++column) {
      const int y = region.first_y + column - gy * kStep;
      const int j = y / kStep;
      const float ty = static_cast<float>(y % kStep) / kStep;
      const float left = a[j] + (b[j] - a[j]) * tx;
      const float right = a[j + 1] + (b[j + 1] - a[j + 1]) * tx;
      region.base_mm[region.at(row, column)] = left + (right - left) * ty;
    }
  }
}

Eigen::Vector3f Ground::albedo(const GroundRegion& region, std::size_t texel, float patch) const {
  const auto moisture = static_cast<float>(parameters_.moisture);
  const float value = region.value[texel];
  const float tint = region.tint[texel];
  if (region.material[texel] == Material::kStone) {
    const Eigen::Vector3f stone(0.30f, 0.28f, 0.25f);
    return stone.cwiseProduct(Eigen::Vector3f(1.0f + 0.12f * tint, 1.0f, 1.0f - 0.14f * tint)) *
           (value * (1.0f - 0.4f * moisture));
  }
  if (region.material[texel] == Material::kStraw) {
    const Eigen::Vector3f straw(0.50f, 0.40f, 0.21f);
    return straw.cwiseProduct(Eigen::Vector3f(1.0f + 0.1f * tint, 1.0f, 1.0f - 0.2f * tint)) *
           (value * (1.0f - 0.35f * moisture));
  }
  const auto patchiness = static_cast<float>(parameters_.moisture_patchiness);
  const auto variation = static_cast<float>(parameters_.color_variation);
  // Tops dry first.
  const float wetness = std::clamp(
      moisture + patchiness * (0.9f * patch - 0.05f * region.relief_mm[texel]) * (0.25f + moisture),
      0.0f, 1.0f);
  const float red = 1.0f + 0.10f * variation * tint;
  Eigen::Vector3f soil = soil_linear_.cwiseProduct(Eigen::Vector3f(red, 1.0f, 1.0f / red)) *
                         (value * (1.0f + 0.25f * variation * patch));
  soil *= 1.0f - 0.62f * wetness;
  soil.z() *= 1.0f - 0.18f * wetness;
  return soil;
}

void Ground::shade(const GroundRegion& region, GroundBlock& block) const {
  const float inverse = static_cast<float>(0.5 / (1e3 * texel_m_));
  const Eigen::Vector3f& sun = light_.to_sun();
  // Patches of colour are three times as wide as the tile's waves.
  std::array<int, GroundBlock::kSize> patch_column{};
  for (int c = 0; c < GroundBlock::kSize; ++c) {
    const int y = c + region.block_column + region.first_y + kTexelLift;
    patch_column[static_cast<std::size_t>(c)] = (y / 3) % kCoarseTileSize;
  }
  for (int r = 0; r < GroundBlock::kSize; ++r) {
    const int row = r + region.block_row;
    const int x = row + region.first_x + kTexelLift;
    const float* coarse = tile_row(coarse_tile_, kCoarseTileSize, x / 3);
    for (int c = 0; c < GroundBlock::kSize; ++c) {
      const std::size_t i = region.at(row, c + region.block_column);
      const auto height = [&](std::size_t k) { return region.relief_mm[k] + region.base_mm[k]; };
      const float slope_x = (height(i + region.columns) - height(i - region.columns)) * inverse;
      const float slope_y = (height(i + 1) - height(i - 1)) * inverse;
      const float norm = 1.0f / std::sqrt(1.0f + slope_x * slope_x + slope_y * slope_y);
      const float facing = std::max((sun.z() - slope_x * sun.x() - slope_y * sun.y()) * norm, 0.0f);
      const float patch = coarse[patch_column[static_cast<std::size_t>(c)]];
      const Eigen::Vector3f sky = light_.sky_rgb() * (region.sky[i] * 0.5f * (1.0f + norm));
      const Eigen::Vector3f direct = light_.sun_rgb() * (facing * region.sun[i]);
      const Eigen::Vector3f total = sky + direct;
      const Eigen::Vector3f bgr = light_.encode_bgr(albedo(region, i, patch).cwiseProduct(total));
      const float shade = 255.0f * std::sqrt(std::min(sky.y() / std::max(total.y(), 1e-6f), 1.0f));
      const auto byte = [](float value) { return static_cast<std::uint32_t>(std::lrint(value)); };
      GroundTexel& texel = block.texels[static_cast<std::size_t>(r) * GroundBlock::kSize + c];
      texel.bgrs = byte(bgr.x()) | byte(bgr.y()) << 8 | byte(bgr.z()) << 16 | byte(shade) << 24;
      texel.height_64um = static_cast<std::int16_t>(
          std::clamp(height(i) * (1e-3f / GroundBlock::kHeightUnit_m), -32000.0f, 32000.0f));
    }
  }
}

}  // namespace furrow::simulation
