// Objects on the soil: crumbs, clods, stones, straw; and cracks in it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "furrow_core/random.hpp"
#include "ground_region.hpp"
#include "noise.hpp"

namespace furrow::simulation {
namespace {

// A kind of lump: radii drawn from a power law between the bounds.
struct LumpKind {
  const char* stream;
  double min_radius_mm;
  double max_radius_mm;
  double cover;     // share of the area
  double cell_mm;   // side of the cells that its places are drawn in
  double flatness;  // height over radius
  Material material;
};

// Radii follow r^-2.5 between two bounds. Mean of r^2 and inverse distribution are in closed form.
class RadiusLaw {
 public:
  explicit RadiusLaw(const LumpKind& kind)
      : least_mm_(kind.min_radius_mm),
        greatest_mm_(std::max(kind.max_radius_mm, 1.05 * least_mm_)),
        norm_((std::pow(least_mm_, -1.5) - std::pow(greatest_mm_, -1.5)) / 1.5) {}

  [[nodiscard]] double greatest_mm() const { return greatest_mm_; }
  [[nodiscard]] double mean_square_mm2() const {
    return (std::sqrt(greatest_mm_) - std::sqrt(least_mm_)) / 0.5 / norm_;
  }
  // `share` in [0, 1] of the lumps are smaller.
  [[nodiscard]] double radius_mm(double share) const {
    return std::pow(std::pow(least_mm_, -1.5) - share * 1.5 * norm_, -1.0 / 1.5);
  }

 private:
  double least_mm_;
  double greatest_mm_;
  double norm_;
};

// An ellipsoid with bumps, in F.
struct Lump {
  double x_mm;
  double y_mm;
  double radius_mm;
  double turn_rad;
  double stretch;
  double flatness;
  double sink;  // share of the height below the ground
  double value;
  double tint;
  double noise_shift;  // texels; which part of the noise tile makes its bumps
  Material material;
};

Lump draw_lump(const LumpKind& kind, const RadiusLaw& law, int cell_x, int cell_y, Random& random) {
  const bool is_stone = kind.material == Material::kStone;
  // The initializers of a list are evaluated in order, so the draws are too.
  return {.x_mm = (cell_x + random.uniform()) * kind.cell_mm,
          .y_mm = (cell_y + random.uniform()) * kind.cell_mm,
          .radius_mm = law.radius_mm(random.uniform()),
          .turn_rad = random.uniform(0.0, std::numbers::pi),
          .stretch = random.uniform(1.0, 1.45),
          .flatness = kind.flatness * random.uniform(0.7, 1.2),
          .sink = random.uniform(0.05, 0.35),
          .value = is_stone ? random.uniform(0.5, 1.5) : random.uniform(0.84, 1.24),
          .tint = random.uniform(-1.0, 1.0),
          .noise_shift = random.uniform(0.0, kFineTileSize),
          .material = kind.material};
}

// Cells of a grid in F, first and last included.
struct CellRange {
  int first_x;
  int last_x;
  int first_y;
  int last_y;
};

// The cells from which an object of size `reach_mm` may touch the region.
CellRange cells_around(const GroundRegion& region, double texel_mm, double cell_mm,
                       double reach_mm) {
  const auto cell_of = [&](double texel, double shift_mm) {
    return static_cast<int>(std::floor((texel * texel_mm + shift_mm) / cell_mm));
  };
  return {cell_of(region.first_x, -reach_mm), cell_of(region.first_x + region.rows, reach_mm),
          cell_of(region.first_y, -reach_mm), cell_of(region.first_y + region.columns, reach_mm)};
}

std::uint64_t cell_index(int x, int y) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
         static_cast<std::uint32_t>(y);
}

// A rectangle of the region's texels.
struct TexelBox {
  int first_row;
  int end_row;
  int first_column;
  int end_column;
};

TexelBox box_of(const Lump& lump, double texel_mm, float row0, float column0,
                const GroundRegion& region) {
  const double long_axis = lump.radius_mm * lump.stretch;
  const double short_axis = lump.radius_mm / lump.stretch;
  const double cosine = std::cos(lump.turn_rad);
  const double sine = std::sin(lump.turn_rad);
  // With its bumps a lump reaches a fifth farther than its ellipse.
  const auto extent = [&](double along_axis, double across_axis) {
    const double square = along_axis * along_axis + across_axis * across_axis;
    return static_cast<float>(1.2 / texel_mm * std::sqrt(square));
  };
  const float extent_x = extent(long_axis * cosine, short_axis * sine);
  const float extent_y = extent(long_axis * sine, short_axis * cosine);
  return {std::max(static_cast<int>(std::ceil(row0 - extent_x)), 0),
          std::min(static_cast<int>(std::floor(row0 + extent_x)) + 1, region.rows),
          std::max(static_cast<int>(std::ceil(column0 - extent_y)), 0),
          std::min(static_cast<int>(std::floor(column0 + extent_y)) + 1, region.columns)};
}

void stamp_lump(const Lump& lump, double texel_mm, const std::vector<float>& fine_tile,
                GroundRegion& region) {
  const auto row0 = static_cast<float>(lump.x_mm / texel_mm - region.first_x);
  const auto column0 = static_cast<float>(lump.y_mm / texel_mm - region.first_y);
  const TexelBox box = box_of(lump, texel_mm, row0, column0, region);
  if (box.first_row >= box.end_row || box.first_column >= box.end_column) return;
  const bool is_stone = lump.material == Material::kStone;
  const auto along = static_cast<float>(texel_mm / (lump.radius_mm * lump.stretch));
  const auto across = static_cast<float>(texel_mm / (lump.radius_mm / lump.stretch));
  const auto cosine = static_cast<float>(std::cos(lump.turn_rad));
  const auto sine = static_cast<float>(std::sin(lump.turn_rad));
  const auto height = static_cast<float>(lump.radius_mm * lump.flatness);
  const auto floor_mm = static_cast<float>(-lump.radius_mm * lump.flatness * lump.sink);
  const float bumps = is_stone ? 0.12f : 0.55f;
  const float roughness = is_stone ? 0.0f : std::min(0.30f * height, 2.5f);
  const auto noise_shift = static_cast<int>(lump.noise_shift);
  for (int row = box.first_row; row < box.end_row; ++row) {
    const float dx = static_cast<float>(row) - row0;
    const float* noise =
        tile_row(fine_tile, kFineTileSize, row + region.first_x + noise_shift + kTexelLift);
    int noise_column = (box.first_column + region.first_y + kTexelLift) % kFineTileSize - 1;
    for (int column = box.first_column; column < box.end_column; ++column) {
      const float dy = static_cast<float>(column) - column0;
      const float e = (dx * cosine + dy * sine) * along;
      const float f = (dy * cosine - dx * sine) * across;
      if (++noise_column == kFineTileSize) noise_column = 0;
      const float bump = noise[noise_column];
      const float d2 = e * e + f * f + bumps * bump;
      if (d2 >= 1.0f) continue;
      const float top = height * std::sqrt(1.0f - std::max(d2, 0.0f) * std::max(d2, 0.0f)) +
                        floor_mm + roughness * bump;
      const std::size_t i = region.at(row, column);
      if (top <= region.relief_mm[i]) continue;
      region.relief_mm[i] = top;
      region.value[i] = static_cast<float>(lump.value);
      region.tint[i] = static_cast<float>(lump.tint);
      region.material[i] = lump.material;
    }
  }
}

// A bent piece of straw or residue, in F.
struct Straw {
  double x_mm;
  double y_mm;
  double heading_rad;
  double length_mm;
  float half_width_mm;
  double bend;  // rad per mm
  float value;
  float tint;
  float lift_mm;
};

constexpr double kStrawCell_mm = 128.0;
constexpr double kStrawReach_mm = 100.0;

Straw draw_straw(int cell_x, int cell_y, Random& random) {
  // The initializers of a list are evaluated in order, so the draws are too.
  return {.x_mm = (cell_x + random.uniform()) * kStrawCell_mm,
          .y_mm = (cell_y + random.uniform()) * kStrawCell_mm,
          .heading_rad = random.uniform(0.0, 2.0 * std::numbers::pi),
          .length_mm = std::min(8.0 + random.exponential(28.0), 95.0),
          .half_width_mm = static_cast<float>(random.uniform(0.5, 1.7)),
          .bend = random.normal(0.0, 0.006),
          .value = static_cast<float>(random.uniform(0.45, 1.1)),
          .tint = static_cast<float>(random.uniform(-1.0, 1.0)),
          .lift_mm = static_cast<float>(random.uniform(1.0, 3.5))};
}

// Covers the texels around one point of a straw.
void stamp_straw_point(const Straw& straw, float row0, float column0, float extent,
                       GroundRegion& region) {
  for (int row = static_cast<int>(std::ceil(row0 - extent));
       static_cast<float>(row) <= row0 + extent; ++row) {
    for (int column = static_cast<int>(std::ceil(column0 - extent));
         static_cast<float>(column) <= column0 + extent; ++column) {
      if (row < 0 || column < 0 || row >= region.rows || column >= region.columns) continue;
      const std::size_t i = region.at(row, column);
      if (region.material[i] == Material::kStraw) continue;
      region.relief_mm[i] = std::max(region.relief_mm[i], 0.0f) + straw.lift_mm;
      region.value[i] = straw.value;
      region.tint[i] = straw.tint;
      region.material[i] = Material::kStraw;
    }
  }
}

void stamp_straw(Straw straw, double texel_mm, GroundRegion& region) {
  const auto inverse_mm = static_cast<float>(1.0 / texel_mm);
  const double step_mm = 0.7 * texel_mm;
  const int steps = static_cast<int>(std::ceil(straw.length_mm / step_mm));
  for (int step = 0; step < steps; ++step) {
    straw.x_mm += step_mm * std::cos(straw.heading_rad);
    straw.y_mm += step_mm * std::sin(straw.heading_rad);
    straw.heading_rad += step_mm * straw.bend;
    stamp_straw_point(straw, static_cast<float>(straw.x_mm / texel_mm - region.first_x),
                      static_cast<float>(straw.y_mm / texel_mm - region.first_y),
                      straw.half_width_mm * inverse_mm, region);
  }
}

}  // namespace

void Ground::add_lumps(GroundRegion& region) const {
  const double texel_mm = 1e3 * texel_m_;
  const GroundParameters& p = parameters_;
  const double clod_mm = std::max(p.clod_size_mm, 8.0);
  const LumpKind kinds[] = {
      {"crumbs", 1.3, 4.0, p.crumb_cover, 64.0, 0.75, Material::kSoil},
      {"small clods", 4.0, 9.0, 0.5 * p.crumb_cover * p.crumb_cover + 0.5 * p.clod_cover, 64.0,
       0.65, Material::kSoil},
      {"clods", 8.0, 0.5 * clod_mm + 4.0, p.clod_cover, 128.0, 0.55, Material::kSoil},
      {"stones", 2.0, 14.0, p.stone_cover, 128.0, 0.5, Material::kStone},
  };
  for (const LumpKind& kind : kinds) {
    if (kind.cover <= 0.0) continue;
    const RadiusLaw law(kind);
    const double per_cell = -std::log(1.0 - std::min(kind.cover, 0.9)) * kind.cell_mm *
                            kind.cell_mm / (std::numbers::pi * law.mean_square_mm2());
    const CellRange cells = cells_around(region, texel_mm, kind.cell_mm, 1.5 * law.greatest_mm());
    for (int cx = cells.first_x; cx <= cells.last_x; ++cx) {
      for (int cy = cells.first_y; cy <= cells.last_y; ++cy) {
        Random random(seed_, kind.stream, cell_index(cx, cy));
        // Clods lie in patches.
        const double patch = 1.0 + 0.7 * value_noise(seed_ + 77, cx * kind.cell_mm / 310.0,
                                                     cy * kind.cell_mm / 310.0);
        const std::int64_t count = random.poisson(per_cell * patch);
        for (std::int64_t n = 0; n < count; ++n) {
          stamp_lump(draw_lump(kind, law, cx, cy, random), texel_mm, fine_tile_, region);
        }
      }
    }
  }
}

void Ground::add_straw(GroundRegion& region) const {
  if (parameters_.straw_per_m2 <= 0.0) return;
  const double texel_mm = 1e3 * texel_m_;
  const double per_cell = parameters_.straw_per_m2 * kStrawCell_mm * kStrawCell_mm * 1e-6;
  const CellRange cells = cells_around(region, texel_mm, kStrawCell_mm, kStrawReach_mm);
  for (int cx = cells.first_x; cx <= cells.last_x; ++cx) {
    for (int cy = cells.first_y; cy <= cells.last_y; ++cy) {
      Random random(seed_, "straw", cell_index(cx, cy));
      const std::int64_t count = random.poisson(per_cell);
      for (std::int64_t n = 0; n < count; ++n) {
        stamp_straw(draw_straw(cx, cy, random), texel_mm, region);
      }
    }
  }
}

void Ground::add_cracks(GroundRegion& region) const {
  if (parameters_.crack_depth_mm <= 0.0) return;
  const double mm = 1e3 * texel_m_;
  constexpr double kCell_mm = 85.0;
  const auto depth = static_cast<float>(parameters_.crack_depth_mm);
  const auto corner = [&](int cx, int cy) {
    return Eigen::Vector2f(
        (static_cast<float>(cx) + 0.5f + 0.45f * lattice_value(seed_ + 5, cx, cy)) *
            static_cast<float>(kCell_mm),
        (static_cast<float>(cy) + 0.5f + 0.45f * lattice_value(seed_ + 6, cx, cy)) *
            static_cast<float>(kCell_mm));
  };
  for (int row = 0; row < region.rows; ++row) {
    for (int column = 0; column < region.columns; ++column) {
      const std::size_t i = region.at(row, column);
      const double x_mm = (region.first_x + row) * mm;
      const double y_mm = (region.first_y + column) * mm;
      // The cell walls of scattered points, warped by the coarse noise.
      const Eigen::Vector2f point(static_cast<float>(x_mm) + 9.0f * region.tint[i],
                                  static_cast<float>(y_mm) + 9.0f * region.value[i]);
      const int cx = static_cast<int>(std::floor(x_mm / kCell_mm));
      const int cy = static_cast<int>(std::floor(y_mm / kCell_mm));
      float nearest = 1e9f;
      float second = 1e9f;
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const float distance = (corner(cx + dx, cy + dy) - point).norm();
          second = std::min(second, std::max(distance, nearest));
          nearest = std::min(nearest, distance);
        }
      }
      const float wall = second - nearest;
      const float open = 1.2f + 1.6f * lattice_value(seed_ + 8, cx, cy);
      if (wall < open) region.relief_mm[i] -= depth * (1.0f - wall / open);
    }
  }
}

}  // namespace furrow::simulation
