#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

enum class GrowthForm : std::uint8_t { kBroadleaf, kGrass };

/// Shape of a plant, for renderers.
enum class LeafForm : std::uint8_t {
  kBeet,
  kBroadleaf,
  kLobed,
  kGrass,
  kFeathery,
  kTrifoliate,
  kRosette,
  kThistle,
  kWhorled,
};

/// "broadleaf", "grass".
[[nodiscard]] std::string_view to_string(GrowthForm form);
/// "beet", "broadleaf", "lobed", and so on.
[[nodiscard]] std::string_view to_string(LeafForm form);

/// Properties of a species. The defaults are rough figures of Furrow's own; replace them in
/// params/species.yaml.
struct Species {
  std::string name;       ///< lower case, words joined by '_'
  std::string botanical;  ///< binomial
  PlantKind kind = PlantKind::kWeed;
  GrowthForm growth_form = GrowthForm::kBroadleaf;
  LeafForm leaf_form = LeafForm::kBroadleaf;
  double beta = 1.0;        ///< harmfulness factor beta_w of the paper's harmfulness equation
  double priority = 1.0;    ///< class weight in planning; the paper uses 0.1 and 1.0
  bool beneficial = false;  ///< a dicot to keep where the crop does not suffer
  double radius_two_leaves_m = 0.012;  ///< canopy radius with two leaves
  double radius_eight_leaves_m = 0.05;
  double leaf_cover = 0.45;  ///< leaf area seen from above over the canopy's disc

  void visit(ParameterVisitor& v);
};

/// The canopy's radius at a growth stage: geometric between two and eight leaves, held outside.
[[nodiscard]] double canopy_radius_m(const Species& species, int leaves);
/// The leaf area seen from above of a canopy of that radius, in mm2.
[[nodiscard]] double leaf_area_mm2(const Species& species, double radius_m);

/// Species by name. Throws ConfigError on an empty, malformed or repeated name or a figure out of
/// its range.
class SpeciesTable {
 public:
  explicit SpeciesTable(std::vector<Species> species);
  /// Sugar beet and twelve weeds that are common in it; the same as params/species.yaml.
  [[nodiscard]] static SpeciesTable defaults();

  [[nodiscard]] const std::vector<Species>& all() const { return species_; }
  /// Null when the name is not in the table; else valid as long as the table.
  [[nodiscard]] const Species* find(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> names(PlantKind kind) const;

 private:
  std::vector<Species> species_;
};

}  // namespace furrow::field
