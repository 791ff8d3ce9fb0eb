#include "furrow_field/statistics.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace furrow::field {

FieldStatistics statistics_of(const FieldModel& field) {
  FieldStatistics result;
  result.area_m2 = field.length_m * field.width_m;
  std::map<std::pair<PlantKind, std::string>, std::size_t> counts;
  double crop_mm2 = 0.0;
  double weed_mm2 = 0.0;
  for (const Plant& plant : field.plants) {
    const bool crop = plant.kind == PlantKind::kCrop;
    ++(crop ? result.crops : result.weeds);
    (crop ? crop_mm2 : weed_mm2) += plant.area_mm2;
    ++counts[{plant.kind, plant.species}];
  }
  if (result.area_m2 > 0.0) {
    result.crops_per_m2 = static_cast<double>(result.crops) / result.area_m2;
    result.weeds_per_m2 = static_cast<double>(result.weeds) / result.area_m2;
    result.crop_cover = 1e-6 * crop_mm2 / result.area_m2;
    result.weed_cover = 1e-6 * weed_mm2 / result.area_m2;
  }
  for (const auto& [key, plants] : counts) {
    result.by_species.push_back({key.second, key.first, plants});
  }
  std::stable_sort(
      result.by_species.begin(), result.by_species.end(),
      [](const SpeciesCount& a, const SpeciesCount& b) { return a.plants > b.plants; });
  return result;
}

}  // namespace furrow::field
