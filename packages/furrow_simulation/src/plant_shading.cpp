#include "plant_shading.hpp"

#include <cmath>
#include <limits>

#include "noise.hpp"
#include "raster.hpp"

namespace furrow::simulation {
namespace {

// The highest surface along parallel rays, on a grid square to them.
class HeightGrid {
 public:
  // Rays come from `direction`, whose z is positive: points are slid along them to z = 0.
  HeightGrid(const PlantMesh& mesh, const Eigen::Vector3f& direction) : direction_(direction) {
    Eigen::Vector2f high = Eigen::Vector2f::Constant(std::numeric_limits<float>::lowest());
    low_ = -high;
    for (const auto& v : mesh.vertices) {
      low_ = low_.cwiseMin(slide(v.p_P));
      high = high.cwiseMax(slide(v.p_P));
    }
    cells_per_m_ = static_cast<float>(kSize - 2) / std::max((high - low_).maxCoeff(), 1e-4f);
    height_.assign(static_cast<std::size_t>(kSize) * kSize, -1.0f);
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f& a = mesh.vertices[t[0]].p_P;
      const Eigen::Vector3f& b = mesh.vertices[t[1]].p_P;
      const Eigen::Vector3f& c = mesh.vertices[t[2]].p_P;
      const float z = (a.z() + b.z() + c.z()) / 3.0f;
      scan_triangle(cell(a), cell(b), cell(c), kSize, 0, kSize, [&](int y, int first, int end) {
        for (int x = first; x < end; ++x) {
          float& top = height_[static_cast<std::size_t>(y) * kSize + x];
          top = std::max(top, z);
        }
      });
    }
  }

  // The share of the neighbourhood of p that is covered by something clearly higher.
  [[nodiscard]] float covered(const Eigen::Vector3f& p, float clearance_m) const {
    const Eigen::Vector2f at = cell(p);
    const auto x = static_cast<int>(std::lround(at.x()));
    const auto y = static_cast<int>(std::lround(at.y()));
    int count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int i = std::clamp(y + dy, 0, kSize - 1) * kSize + std::clamp(x + dx, 0, kSize - 1);
        if (height_[static_cast<std::size_t>(i)] > p.z() + clearance_m) ++count;
      }
    }
    return static_cast<float>(count) / 9.0f;
  }

 private:
  static constexpr int kSize = 72;

  [[nodiscard]] Eigen::Vector2f slide(const Eigen::Vector3f& p) const {
    return p.head<2>() - direction_.head<2>() * (p.z() / direction_.z());
  }
  [[nodiscard]] Eigen::Vector2f cell(const Eigen::Vector3f& p) const {
    return (slide(p) - low_) * cells_per_m_ + Eigen::Vector2f::Constant(0.5f);
  }

  Eigen::Vector3f direction_;
  Eigen::Vector2f low_;
  float cells_per_m_ = 1.0f;
  std::vector<float> height_;
};

}  // namespace

std::vector<VertexLight> light_plant(const PlantMesh& mesh, const Light& light, double gloss) {
  const Eigen::Vector3f& sun = light.to_sun();
  const HeightGrid towards_sun(mesh, sun);
  const HeightGrid upwards(mesh, Eigen::Vector3f::UnitZ());
  const auto radius = static_cast<float>(mesh.radius_m);
  const float clearance = std::max(0.06f * radius, 0.0015f);
  const Eigen::Vector3f half = (sun + Eigen::Vector3f::UnitZ()).normalized();
  const auto shine = static_cast<float>(gloss);
  std::vector<VertexLight> lights;
  lights.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices) {
    const Eigen::Vector3f& n = v.normal_P;
    const float open = 1.0f - 0.85f * towards_sun.covered(v.p_P, clearance);
    const float sky_seen = (1.0f - 0.45f * upwards.covered(v.p_P, clearance)) *
                           (0.75f + 0.25f * std::min(v.p_P.z() / (0.3f * radius + 1e-4f), 1.0f)) *
                           0.5f * (1.0f + n.z());
    const float facing = n.dot(sun);
    const float front = std::max(facing, 0.0f);
    // Light through the blade is yellower; it also brightens shaded parts under other leaves.
    const float through = 0.35f * std::max(-facing, 0.0f) * open + 0.12f * (1.0f - open);
    const Eigen::Vector3f transmitted(1.15f, 1.25f, 0.55f);
    const Eigen::Vector3f direct = light.sun_rgb().cwiseProduct(
        v.albedo_rgb.cwiseProduct(Eigen::Vector3f::Constant(front * open) + transmitted * through));
    const float mirror = std::max(n.dot(half), 0.0f);
    const float highlight = std::pow(mirror, 24.0f) * 0.30f * shine * open;
    const Eigen::Vector3f gleam = light.sun_rgb() * highlight;
    // A leaf mirrors the sky a little wherever it lies.
    const Eigen::Vector3f sky = light.sky_rgb().cwiseProduct(
        v.albedo_rgb * sky_seen + Eigen::Vector3f::Constant(0.03f * shine * sky_seen));
    VertexLight out;
    out.bgr = light.encode_bgr(sky + direct + gleam);
    const float total = (sky + direct + gleam).y();
    out.shade = std::sqrt(std::min(sky.y() / std::max(total, 1e-6f), 1.0f));
    lights.push_back(out);
  }
  return lights;
}

LeafTexture::LeafTexture(std::uint64_t seed, double damage)
    : factor_(static_cast<std::size_t>(kAlong) * kAcross) {
  const auto spots = static_cast<float>(0.55 * damage);
  for (int i = 0; i < kAlong; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const float u = (static_cast<float>(i) + 0.5f) / kAlong;
      const float s = std::abs((static_cast<float>(j) + 0.5f) / (0.5f * kAcross) - 1.0f);
      const float midrib = std::exp(-s * s / (0.006f * (1.15f - u)));
      // Side veins run outwards and towards the tip.
      const float run = std::fmod(7.0f * (u - 0.28f * s) + 7.0f, 1.0f) - 0.5f;
      const float vein = std::exp(-run * run / 0.006f) * (1.0f - s);
      const float mottle =
          value_noise(seed, i / 5.0, j / 5.0) + 0.6f * value_noise(seed + 1, i / 2.0, j / 2.0);
      const float spot = std::max(value_noise(seed + 2, i / 3.5, j / 3.5) - 0.45f, 0.0f);
      factor_[static_cast<std::size_t>(i) * kAcross + j] =
          std::clamp(0.97f + 0.22f * midrib + 0.10f * vein + 0.05f * mottle -
                         (s > 0.9f ? 0.06f : 0.0f) + (i % 3 == 0 ? -1.0f : 1.0f) * spots * spot,
                     0.5f, 1.4f);
    }
  }
}

}  // namespace furrow::simulation
