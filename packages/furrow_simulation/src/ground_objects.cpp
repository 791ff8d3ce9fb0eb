// What lies on the soil: crumbs, clods, stones and straw.
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
  double cover;
  double cell_mm;   // side of the cells that its places are drawn in
  double flatness;  // height over radius
  Material material;
};

std::uint64_t cell_index(int x, int y) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
         static_cast<std::uint32_t>(y);
}

}  // namespace

void Ground::stamp_objects(Region& region) const {
  const double mm = 1e3 * texel_m_;  // per texel
  const auto inverse_mm = static_cast<float>(1.0 / mm);
  const GroundParameters& p = parameters_;
  const double clod = std::max(p.clod_size_mm, 8.0);
  const LumpKind kinds[] = {
      {"crumbs", 1.3, 4.0, p.crumb_cover, 64.0, 0.75, Material::kSoil},
      {"small clods", 4.0, 9.0, 0.5 * p.crumb_cover * p.crumb_cover + 0.5 * p.clod_cover, 64.0,
       0.65, Material::kSoil},
      {"clods", 8.0, 0.5 * clod + 4.0, p.clod_cover, 128.0, 0.55, Material::kSoil},
      {"stones", 2.0, 14.0, p.stone_cover, 128.0, 0.5, Material::kStone},
  };
  for (const LumpKind& kind : kinds) {
    if (kind.cover <= 0.0) continue;
    // Radii follow r^-2.5 between a and b: mean of r^2 in closed form.
    const double a = kind.min_radius_mm;
    const double b = std::max(kind.max_radius_mm, 1.05 * a);
    const double norm = (std::pow(a, -1.5) - std::pow(b, -1.5)) / 1.5;
    const double mean_square = (std::sqrt(b) - std::sqrt(a)) / 0.5 / norm;
    const double per_cell = -std::log(1.0 - std::min(kind.cover, 0.9)) * kind.cell_mm *
                            kind.cell_mm / (std::numbers::pi * mean_square);
    const double reach = 1.5 * b;
    const auto cell_of = [&](double texel, double shift) {
      return static_cast<int>(std::floor((texel * mm + shift) / kind.cell_mm));
    };
    const int last_x = cell_of(region.first_x + region.rows, reach);
    const int last_y = cell_of(region.first_y + region.columns, reach);
    for (int cx = cell_of(region.first_x, -reach); cx <= last_x; ++cx) {
      for (int cy = cell_of(region.first_y, -reach); cy <= last_y; ++cy) {
        Random random(seed_, kind.stream, cell_index(cx, cy));
        // Clods lie in patches.
        const double patch = 1.0 + 0.7 * value_noise(seed_ + 77, cx * kind.cell_mm / 310.0,
                                                     cy * kind.cell_mm / 310.0);
        const std::int64_t count = random.poisson(per_cell * patch);
        for (std::int64_t n = 0; n < count; ++n) {
          const double x_mm = (cx + random.uniform()) * kind.cell_mm;
          const double y_mm = (cy + random.uniform()) * kind.cell_mm;
          const double draw = random.uniform();
          const double radius = std::pow(std::pow(a, -1.5) - draw * 1.5 * norm, -1.0 / 1.5);
          const double turn = random.uniform(0.0, std::numbers::pi);
          const double stretch = random.uniform(1.0, 1.45);
          const double flat = kind.flatness * random.uniform(0.7, 1.2);
          const double sink = random.uniform(0.05, 0.35);
          const double value = kind.material == Material::kStone ? random.uniform(0.5, 1.5)
                                                                 : random.uniform(0.84, 1.24);
          const double tint = random.uniform(-1.0, 1.0);
          const double shift = random.uniform(0.0, kFineTileSize);
          const auto row0 = static_cast<float>(x_mm / mm - region.first_x);
          const auto column0 = static_cast<float>(y_mm / mm - region.first_y);
          const double long_axis = radius * stretch;
          const double short_axis = radius / stretch;
          const double cosine_d = std::cos(turn);
          const double sine_d = std::sin(turn);
          // With its bumps a lump reaches a fifth farther than its ellipse.
          const auto extent = [&](double along_axis, double across_axis) {
            const double square = along_axis * along_axis + across_axis * across_axis;
            return static_cast<float>(1.2 / mm * std::sqrt(square));
          };
          const float extent_x = extent(long_axis * cosine_d, short_axis * sine_d);
          const float extent_y = extent(long_axis * sine_d, short_axis * cosine_d);
          const int first_row = std::max(static_cast<int>(std::ceil(row0 - extent_x)), 0);
          const int end_row =
              std::min(static_cast<int>(std::floor(row0 + extent_x)) + 1, region.rows);
          const int first_column = std::max(static_cast<int>(std::ceil(column0 - extent_y)), 0);
          const int end_column =
              std::min(static_cast<int>(std::floor(column0 + extent_y)) + 1, region.columns);
          if (first_row >= end_row || first_column >= end_column) continue;
          const auto along = static_cast<float>(mm / long_axis);
          const auto across = static_cast<float>(mm / short_axis);
          const auto cosine = static_cast<float>(cosine_d);
          const auto sine = static_cast<float>(sine_d);
          const auto height = static_cast<float>(radius * flat);
          const auto floor_mm = static_cast<float>(-radius * flat * sink);
          const float bumps = kind.material == Material::kStone ? 0.12f : 0.55f;
          const float roughness =
              kind.material == Material::kStone ? 0.0f : std::min(0.30f * height, 2.5f);
          const auto noise_shift = static_cast<int>(shift);
          for (int row = first_row; row < end_row; ++row) {
            const float dx = static_cast<float>(row) - row0;
            const float* noise = tile_row(fine_tile_, kFineTileSize,
                                          row + region.first_x + noise_shift + kTexelLift);
            int noise_column = (first_column + region.first_y + kTexelLift) % kFineTileSize - 1;
            for (int column = first_column; column < end_column; ++column) {
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
              region.value[i] = static_cast<float>(value);
              region.tint[i] = static_cast<float>(tint);
              region.material[i] = kind.material;
            }
          }
        }
      }
    }
  }
  if (p.straw_per_m2 <= 0.0) return;
  constexpr double kCell_mm = 128.0;
  const auto cell_of = [&](double texel, double shift) {
    return static_cast<int>(std::floor((texel * mm + shift) / kCell_mm));
  };
  const double per_cell = p.straw_per_m2 * kCell_mm * kCell_mm * 1e-6;
  for (int cx = cell_of(region.first_x, -100.0); cx <= cell_of(region.first_x + region.rows, 100.0);
       ++cx) {
    for (int cy = cell_of(region.first_y, -100.0);
         cy <= cell_of(region.first_y + region.columns, 100.0); ++cy) {
      Random random(seed_, "straw", cell_index(cx, cy));
      const std::int64_t count = random.poisson(per_cell);
      for (std::int64_t n = 0; n < count; ++n) {
        double x = (cx + random.uniform()) * kCell_mm;
        double y = (cy + random.uniform()) * kCell_mm;
        double heading = random.uniform(0.0, 2.0 * std::numbers::pi);
        const double length = std::min(8.0 + random.exponential(28.0), 95.0);
        const auto half_width = static_cast<float>(random.uniform(0.5, 1.7));
        const double bend = random.normal(0.0, 0.006);
        const auto value = static_cast<float>(random.uniform(0.45, 1.1));
        const auto tint = static_cast<float>(random.uniform(-1.0, 1.0));
        const auto lift = static_cast<float>(random.uniform(1.0, 3.5));
        const int steps = static_cast<int>(std::ceil(length / (0.7 * mm)));
        for (int step = 0; step < steps; ++step) {
          x += 0.7 * mm * std::cos(heading);
          y += 0.7 * mm * std::sin(heading);
          heading += 0.7 * mm * bend;
          const auto row0 = static_cast<float>(x / mm - region.first_x);
          const auto column0 = static_cast<float>(y / mm - region.first_y);
          const float extent = half_width * inverse_mm;
          for (int row = static_cast<int>(std::ceil(row0 - extent));
               static_cast<float>(row) <= row0 + extent; ++row) {
            for (int column = static_cast<int>(std::ceil(column0 - extent));
                 static_cast<float>(column) <= column0 + extent; ++column) {
              if (row < 0 || column < 0 || row >= region.rows || column >= region.columns) continue;
              const std::size_t i = region.at(row, column);
              if (region.material[i] == Material::kStraw) continue;
              region.relief_mm[i] = std::max(region.relief_mm[i], 0.0f) + lift;
              region.value[i] = value;
              region.tint[i] = tint;
              region.material[i] = Material::kStraw;
            }
          }
        }
      }
    }
  }
}

void Ground::add_cracks(Region& region) const {
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
