#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "furrow_simulation/light.hpp"
#include "furrow_simulation/plant_mesh.hpp"

namespace furrow::simulation {

/// The light that a vertex sends up to the camera.
struct VertexLight {
  Eigen::Vector3f bgr = Eigen::Vector3f::Zero();  ///< in [0, 255]
  float shade = 1.0f;  ///< brightness out of the sun, as a share of `bgr`
};

/// Lights a plant as seen from above: sun, sky, light through the leaf, gloss, the shadows that its
/// leaves throw on each other. In the order of the mesh's vertices.
[[nodiscard]] std::vector<VertexLight> light_plant(const PlantMesh& mesh, const Light& light,
                                                   double gloss);

/// Brightness within a blade: midrib, side veins, mottling. Sampled by PlantVertex::leaf.
class LeafTexture {
 public:
  static constexpr int kAlong = 64;
  static constexpr int kAcross = 32;

  LeafTexture(std::uint64_t seed, double damage);

  /// A factor for the colour. Coordinates outside are held at the border.
  [[nodiscard]] float sample(float along, float across) const {
    const int i = std::clamp(static_cast<int>(along * kAlong), 0, kAlong - 1);
    const int j = std::clamp(static_cast<int>((across + 1.0f) * (0.5f * kAcross)), 0, kAcross - 1);
    return factor_[static_cast<std::size_t>(i) * kAcross + j];
  }

 private:
  std::vector<float> factor_;
};

}  // namespace furrow::simulation
