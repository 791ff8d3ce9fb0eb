#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "furrow_field/field_model.hpp"

namespace furrow::field {

struct SpeciesCount {
  std::string species;
  PlantKind kind = PlantKind::kWeed;
  std::size_t plants = 0;
};

struct FieldStatistics {
  double area_m2 = 0.0;
  std::size_t crops = 0;
  std::size_t weeds = 0;
  double crops_per_m2 = 0.0;
  double weeds_per_m2 = 0.0;
  double crop_cover = 0.0;  ///< leaf area over ground area, overlaps counted twice
  double weed_cover = 0.0;
  std::vector<SpeciesCount> by_species;  ///< most plants first, then by kind and name
};

/// Rates are 0 for a field without area.
[[nodiscard]] FieldStatistics statistics_of(const FieldModel& field);

}  // namespace furrow::field
