#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

enum class GrowthForm : std::uint8_t { kBroadleaf, kGrass };

/// The outline of a leaf seen from above, for renderers.
enum class LeafOutline : std::uint8_t {
  kOval,
  kRound,
  kLanceolate,
  kHeart,
  kLobed,
  kFeathery,
  kBlade
};

[[nodiscard]] std::string_view to_string(GrowthForm form);
[[nodiscard]] std::string_view to_string(LeafOutline outline);

/// What is known of a species. Names are botanical binomials; figures are Furrow's own defaults, to
/// be replaced by the user's in params/species.yaml.
struct Species {
  std::string name;
  PlantKind kind = PlantKind::kWeed;
  GrowthForm growth_form = GrowthForm::kBroadleaf;
  double beta = 1.0;        ///< harmfulness factor beta_w of the paper's harmfulness equation
  double priority = 1.0;    ///< class weight in planning; the paper uses 0.1 and 1.0
  bool beneficial = false;  ///< a dicot worth leaving where the crop does not suffer
  LeafOutline leaf_outline = LeafOutline::kOval;
  double leaf_aspect = 1.5;            ///< length over width of a leaf
  double radius_two_leaves_m = 0.012;  ///< canopy radius with two leaves
  double radius_eight_leaves_m = 0.05;
  double leaf_cover = 0.45;  ///< leaf area seen from above over the canopy's disc
  std::vector<double> leaf_rgb = {0.30, 0.52, 0.20};  ///< mean reflectance, 0 to 1

  void visit(ParameterVisitor& v);
};

/// The canopy's radius at a growth stage: geometric between two and eight leaves, held outside.
[[nodiscard]] double canopy_radius_m(const Species& species, int leaves);
/// The leaf area seen from above of a canopy of that radius, in mm2.
[[nodiscard]] double leaf_area_mm2(const Species& species, double radius_m);

/// Species by name. Throws ConfigError on an empty or repeated name or an impossible figure.
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
