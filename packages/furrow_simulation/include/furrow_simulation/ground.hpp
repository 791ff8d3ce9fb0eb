#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_simulation/light.hpp"

namespace furrow::simulation {

/// The soil surface. Covers are shares of the area.
struct GroundParameters {
  std::vector<double> soil_rgb = {0.56, 0.46, 0.37};
  double moisture = 0.2;
  double moisture_patchiness = 0.4;
  double color_variation = 0.5;
  double undulation_mm = 6.0;
  double roughness_mm = 0.5;
  double crumb_cover = 0.5;
  double clod_cover = 0.10;
  double clod_size_mm = 28.0;
  double stone_cover = 0.008;
  double straw_per_m2 = 6.0;
  double crack_depth_mm = 0.0;
  double ground_resolution_mm = 1.0;

  void visit(ParameterVisitor& v);
};

/// A lit point of the ground. `bgrs` holds blue in its lowest byte, then green, red, and the share
/// (of 255) of the brightness that remains without the sun.
struct GroundTexel {
  std::uint32_t bgrs = 0;
  std::int16_t height_64um = 0;
  std::uint16_t unused = 0;  ///< keeps a texel to eight bytes
};

/// A square of the ground in F: kSize rows along +x, each of kSize texels along +y.
struct GroundBlock {
  static constexpr int kSize = 256;
  static constexpr float kHeightUnit_m = 64e-6f;
  std::vector<GroundTexel> texels;
};

/// A triangle of a plant that casts a shadow on the ground; corners in F, in m.
struct ShadowTriangle {
  Eigen::Vector3f corner[3];
};

struct GroundRegion;

/// Uneven soil with crumbs, clods, stones, straw and cracks. It never repeats: each block depends
/// on the seed and its place only.
class Ground {
 public:
  /// Throws ConfigError for a colour that is not three finite numbers.
  Ground(const GroundParameters& parameters, const Light& light, std::uint64_t seed);

  [[nodiscard]] double texel_m() const { return texel_m_; }
  /// The smooth part of the surface: undulation without clods. Plants stand on it.
  [[nodiscard]] double base_height_m(double x_F_m, double y_F_m) const;
  /// The block with the corner texel (block_x * kSize, block_y * kSize), with the shadows of
  /// `casters`.
  void make_block(std::int32_t block_x, std::int32_t block_y,
                  const std::vector<ShadowTriangle>& casters, GroundBlock& block) const;
  /// The largest distance from which an object of this height can shade a block.
  [[nodiscard]] double shadow_length_m(double height_m) const;

 private:
  void add_noise(GroundRegion& region) const;
  void add_smooth_ground(GroundRegion& region) const;
  void add_cracks(GroundRegion& region) const;
  void add_lumps(GroundRegion& region) const;
  void add_straw(GroundRegion& region) const;
  void shade(const GroundRegion& region, GroundBlock& block) const;
  [[nodiscard]] Eigen::Vector3f albedo(const GroundRegion& region, std::size_t texel,
                                       float patch) const;

  GroundParameters parameters_;
  Light light_;
  std::uint64_t seed_;
  double texel_m_;
  std::vector<float> fine_tile_;
  std::vector<float> coarse_tile_;
  Eigen::Vector3f soil_linear_;
};

}  // namespace furrow::simulation
