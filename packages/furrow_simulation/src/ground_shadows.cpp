// Light on the ground: shadows of plants and of the relief, and the visible part of the sky.
#include <algorithm>
#include <cmath>

#include "ground_region.hpp"
#include "raster.hpp"

namespace furrow::simulation {
namespace {

constexpr int kSkyRadius = 6;     // texels
constexpr int kCanopyRadius = 9;  // texels

void box_blur(std::vector<float>& image, int rows, int columns, int radius,
              std::vector<float>& scratch) {
  scratch.resize(image.size());
  const float scale = 1.0f / static_cast<float>(2 * radius + 1);
  for (int row = 0; row < rows; ++row) {
    const float* in = image.data() + static_cast<std::ptrdiff_t>(row) * columns;
    float* out = scratch.data() + static_cast<std::ptrdiff_t>(row) * columns;
    float sum = 0.0f;
    for (int k = -radius; k <= radius; ++k) sum += in[std::clamp(k, 0, columns - 1)];
    for (int column = 0; column < columns; ++column) {
      out[column] = sum * scale;
      sum += in[std::min(column + radius + 1, columns - 1)] - in[std::max(column - radius, 0)];
    }
  }
  std::vector<float> sums(static_cast<std::size_t>(columns), 0.0f);
  const auto line = [&](int row) {
    return scratch.data() + static_cast<std::ptrdiff_t>(std::clamp(row, 0, rows - 1)) * columns;
  };
  for (int k = -radius; k <= radius; ++k) {
    const float* in = line(k);
    for (int column = 0; column < columns; ++column) sums[column] += in[column];
  }
  for (int row = 0; row < rows; ++row) {
    float* out = image.data() + static_cast<std::ptrdiff_t>(row) * columns;
    const float* enter = line(row + radius + 1);
    const float* leave = line(row - radius);
    for (int column = 0; column < columns; ++column) {
      out[column] = sums[column] * scale;
      sums[column] += enter[column] - leave[column];
    }
  }
}

// Projects the triangles of plants on the ground: along the sun's rays into region.sun, straight
// down into `canopy`.
void project_plants(GroundRegion& region, const std::vector<ShadowTriangle>& casters,
                    const Eigen::Vector3f& to_sun, double texel_m, std::vector<float>& canopy) {
  const auto texel = static_cast<float>(1.0 / texel_m);
  const Eigen::Vector2f origin(static_cast<float>(region.first_y),
                               static_cast<float>(region.first_x));
  const float ground_m = 1e-3f * region.base_mm[region.at(region.rows / 2, region.columns / 2)];
  for (const ShadowTriangle& triangle : casters) {
    Eigen::Vector2f along[3];
    Eigen::Vector2f down[3];
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3f& p = triangle.corner[i];
      const float drop = std::max(p.z() - ground_m, 0.0f) / to_sun.z();
      down[i] = Eigen::Vector2f(p.y(), p.x()) * texel - origin;
      along[i] =
          Eigen::Vector2f(p.y() - drop * to_sun.y(), p.x() - drop * to_sun.x()) * texel - origin;
    }
    const auto fill = [&](const Eigen::Vector2f* corner, std::vector<float>& mask, float value) {
      scan_triangle(corner[0], corner[1], corner[2], region.columns, 0, region.rows,
                    [&](int row, int first, int end) {
                      std::fill(
                          mask.begin() + static_cast<std::ptrdiff_t>(region.at(row, first)),
                          mask.begin() + static_cast<std::ptrdiff_t>(region.at(row, end - 1)) + 1,
                          value);
                    });
    };
    fill(along, region.sun, 0.06f);
    fill(down, canopy, 1.0f);
  }
}

// Shadows of the relief. The height of the shade is carried away from the sun, line by line of the
// axis that lies nearer to the sun's direction.
void shade_relief(GroundRegion& region, const Eigen::Vector3f& to_sun, double texel_m) {
  const auto mm = static_cast<float>(1e3 * texel_m);
  const bool by_rows = std::abs(to_sun.x()) >= std::abs(to_sun.y());
  const float major = by_rows ? to_sun.x() : to_sun.y();
  const float minor = by_rows ? to_sun.y() : to_sun.x();
  if (std::abs(major) <= 0.02f) return;
  const int lines = by_rows ? region.rows : region.columns;
  const int length = by_rows ? region.columns : region.rows;
  const std::ptrdiff_t line_stride = by_rows ? region.columns : 1;
  const std::ptrdiff_t stride = by_rows ? 1 : region.columns;
  const float sideways = minor / std::abs(major);  // towards the sun, per line
  const float drop = mm * to_sun.z() / std::abs(major);
  const int from = major > 0.0f ? lines - 1 : 0;
  const int step = major > 0.0f ? -1 : 1;
  const auto whole = static_cast<int>(std::floor(sideways));
  const float part = sideways - static_cast<float>(whole);
  std::vector<float> shade_height(static_cast<std::size_t>(length) + 4, -1e6f);
  std::vector<float> next(shade_height);
  for (int n = 0; n < lines; ++n) {
    const std::ptrdiff_t line = static_cast<std::ptrdiff_t>(from + step * n) * line_stride;
    for (int k = 0; k < length; ++k) {
      const std::ptrdiff_t i = line + k * stride;
      const float height = region.relief_mm[i];
      const float a =
          shade_height[static_cast<std::size_t>(std::clamp(k + whole + 2, 0, length + 3))];
      const float b =
          shade_height[static_cast<std::size_t>(std::clamp(k + whole + 3, 0, length + 3))];
      const float shadow = a + (b - a) * part - drop;
      const float dark = std::clamp((shadow - height) * 1.2f, 0.0f, 1.0f);
      region.sun[i] *= 1.0f - dark;
      next[static_cast<std::size_t>(k) + 2] = std::max(shadow, height);
    }
    std::swap(shade_height, next);
  }
}

}  // namespace

void cast_shadows(GroundRegion& region, const std::vector<ShadowTriangle>& casters,
                  const Eigen::Vector3f& to_sun, double texel_m) {
  const std::size_t count = region.relief_mm.size();
  region.sun.assign(count, 1.0f);
  region.sky.assign(count, 1.0f);
  std::vector<float> scratch;
  std::vector<float> canopy;
  if (!casters.empty()) {
    canopy.assign(count, 0.0f);
    project_plants(region, casters, to_sun, texel_m, canopy);
    box_blur(region.sun, region.rows, region.columns, 1, scratch);
    box_blur(canopy, region.rows, region.columns, kCanopyRadius, scratch);
  }
  shade_relief(region, to_sun, texel_m);

  // Hollows and the ground under a canopy get less light of the sky.
  std::vector<float> mean = region.relief_mm;
  box_blur(mean, region.rows, region.columns, kSkyRadius, scratch);
  for (std::size_t i = 0; i < count; ++i) {
    const float hollow = (mean[i] - region.relief_mm[i]) / (2.0f + 0.2f * std::abs(mean[i]));
    region.sky[i] = 1.0f - std::clamp(0.30f * hollow, -0.12f, 0.55f);
  }
  for (std::size_t i = 0; i < canopy.size(); ++i) region.sky[i] *= 1.0f - 0.6f * canopy[i];
}

}  // namespace furrow::simulation
