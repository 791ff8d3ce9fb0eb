#include "plant_cache.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::simulation {
namespace {

constexpr std::size_t kMaxPlants = 4096;
constexpr double kMaxCoordinate_m = 5000.0;

}  // namespace

PlantCache::PlantCache(const field::FieldModel& field, const field::SpeciesTable& species,
                       const PlantParameters& parameters, const Light& light, const Ground& ground,
                       std::uint64_t seed)
    : field_(field),
      species_(species),
      parameters_(parameters),
      light_(light),
      ground_(ground),
      seed_(seed) {
  by_x_.reserve(field.plants.size());
  radius_m_.reserve(field.plants.size());
  for (std::size_t i = 0; i < field.plants.size(); ++i) {
    const field::Plant& plant = field.plants[i];
    if (!plant.p_F_m.allFinite() || plant.p_F_m.cwiseAbs().maxCoeff() > kMaxCoordinate_m) {
      throw ConfigError("renderer: plant " + std::to_string(plant.id) +
                        " does not stand within 5 km of the field's origin");
    }
    by_x_.push_back({plant.p_F_m.x(), i});
    radius_m_.push_back(max_mesh_radius_m(plant));
    max_radius_m_ = std::max(max_radius_m_, radius_m_.back());
  }
  std::sort(by_x_.begin(), by_x_.end(), [](const Place& a, const Place& b) {
    return a.x_m < b.x_m || (a.x_m == b.x_m && a.index < b.index);
  });
}

const BuiltPlant& PlantCache::get(std::size_t plant_index) {
  const auto [it, is_new] = built_.try_emplace(plant_index);
  BuiltPlant& built = it->second;
  built.last_use = clock_;
  if (is_new) {
    const field::Plant& plant = field_.plants[plant_index];
    built.form = leaf_form(species_, plant);
    built.mesh = build_plant_mesh(plant, built.form, parameters_, seed_);
    built.lights = light_plant(built.mesh, light_, parameters_.leaf_gloss);
    built.p_F = Eigen::Vector3d(plant.p_F_m.x(), plant.p_F_m.y(),
                                ground_.base_height_m(plant.p_F_m.x(), plant.p_F_m.y()))
                    .cast<float>();
  }
  return built;
}

void PlantCache::forget_unused() {
  if (built_.size() > kMaxPlants) {
    std::erase_if(built_, [&](const auto& entry) { return entry.second.last_use < clock_; });
  }
  ++clock_;
}

}  // namespace furrow::simulation
