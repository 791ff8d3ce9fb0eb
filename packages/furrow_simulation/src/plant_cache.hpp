#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "furrow_simulation/ground.hpp"
#include "furrow_simulation/plant_mesh.hpp"
#include "plant_shading.hpp"

namespace furrow::simulation {

/// A plant with its mesh and light.
struct BuiltPlant {
  PlantMesh mesh;
  std::vector<VertexLight> lights;
  Eigen::Vector3f p_F = Eigen::Vector3f::Zero();  ///< the stem on the ground
  field::LeafForm form = field::LeafForm::kBeet;
  std::uint64_t last_use = 0;
};

/// Builds plants when they are first asked for, and finds them by place.
class PlantCache {
 public:
  /// @pre all references outlive the cache.
  PlantCache(const field::FieldModel& field, const field::SpeciesTable& species,
             const PlantParameters& parameters, const Light& light, const Ground& ground,
             std::uint64_t seed);

  /// The reference stays valid until the next call of forget_unused.
  [[nodiscard]] const BuiltPlant& get(std::size_t plant_index);
  /// Indices, ascending, of plants that stand within the box widened by reach(plant's radius).
  template <class Reach>
  [[nodiscard]] std::vector<std::size_t> find(double min_x_m, double max_x_m, double min_y_m,
                                              double max_y_m, const Reach& reach) const;
  /// Bounds the cache; call between frames.
  void forget_unused();

 private:
  struct Place {
    double x_m = 0.0;
    std::size_t index = 0;
  };

  const field::FieldModel& field_;
  const field::SpeciesTable& species_;
  const PlantParameters& parameters_;
  const Light& light_;
  const Ground& ground_;
  std::uint64_t seed_;
  double max_radius_m_ = 0.0;
  std::vector<Place> by_x_;
  std::vector<double> radius_m_;  // bound on each plant's mesh
  std::unordered_map<std::size_t, BuiltPlant> built_;
  std::uint64_t clock_ = 0;
};

template <class Reach>
std::vector<std::size_t> PlantCache::find(double min_x_m, double max_x_m, double min_y_m,
                                          double max_y_m, const Reach& reach) const {
  std::vector<std::size_t> found;
  const double most = reach(max_radius_m_);
  auto it = std::lower_bound(by_x_.begin(), by_x_.end(), min_x_m - most,
                             [](const Place& place, double x) { return place.x_m < x; });
  for (; it != by_x_.end() && it->x_m <= max_x_m + most; ++it) {
    const double own = reach(radius_m_[it->index]);
    const double y = field_.plants[it->index].p_F_m.y();
    if (it->x_m < min_x_m - own || it->x_m > max_x_m + own || y < min_y_m - own ||
        y > max_y_m + own) {
      continue;
    }
    found.push_back(it->index);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace furrow::simulation
