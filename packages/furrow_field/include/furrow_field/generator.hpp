#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_field/species.hpp"

namespace furrow::field {

/// Parameters of a generated field; the keys of the presets in params/fields/.
struct FieldParameters {
  std::string name = "generated";
  double length_m = 20.0;
  double width_m = 1.39;

  double weeds_per_m2 = 8.2;
  /// "poisson": homogeneous; "clusters": a Thomas process (Thomas 1949).
  std::string pattern = "poisson";
  double cluster_weeds = 8.0;
  double cluster_sd_m = 0.12;
  std::vector<std::string> weed_species;  ///< empty: every weed of the table
  std::vector<double> weed_shares;        ///< of weed_species; empty: equal
  std::int64_t weed_leaves_min = 2;
  std::int64_t weed_leaves_max = 6;

  bool crop = true;  ///< false: weeds only
  std::string crop_species = "sugar_beet";
  double row_spacing_m = 0.5;
  double row_offset_m = 0.0;
  double plant_spacing_m = 0.19;
  double plant_spacing_sd_m = 0.015;
  double row_sd_m = 0.008;
  double missing_probability = 0.05;
  std::int64_t crop_leaves_min = 4;
  std::int64_t crop_leaves_max = 8;

  double size_sd = 0.15;
  double weed_to_crop_min_m = 0.02;
  double weed_to_weed_min_m = 0.0;

  void visit(ParameterVisitor& v);
};

/// Generates a field. The expected number of weeds is weeds_per_m2 times the area, also with
/// minimum distances: a weed that is too near is drawn again. Deterministic in (parameters,
/// species, seed); crop and weeds use separate random streams. Errors: kOutOfRange (a parameter, or
/// more than kMaxPlants), kNotFound (a species), kNoSolution (the distances leave no room).
[[nodiscard]] Result<FieldModel> generate_field(const FieldParameters& parameters,
                                                const SpeciesTable& species, std::uint64_t seed);

}  // namespace furrow::field
