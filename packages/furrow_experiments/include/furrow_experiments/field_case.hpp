#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::experiments {

/// A kind of field: generated anew for each seed, or one that was imported.
struct FieldCase {
  std::string name;
  double weeds_per_m2 = 0.0;
  std::optional<field::FieldModel> imported;
};

/// The five densities of the paper's tables.
[[nodiscard]] std::vector<FieldCase> paper_field_cases();
/// Its density is counted. Error: validate() fails, or it has no area.
[[nodiscard]] Result<FieldCase> imported_field_case(field::FieldModel field);

/// What a row of generated field looks like besides its density.
struct RowParameters {
  double length_m = 20.0;
  double width_m = 1.39;
  std::string pattern = "poisson";
  bool crop = false;

  void visit(ParameterVisitor& v);
};

/// A field as planners see it.
struct FieldTargets {
  double length_m = 0.0;
  std::vector<planning::Target> weeds;          ///< by x; ids 0, 1, ...; weight 1
  std::vector<bool> high_priority;              ///< of each weed
  std::vector<planning::ProtectedPlant> crops;  ///< by x
};

/// One weed in eleven, drawn at random from a stream of its own, is of high priority: one to ten,
/// as in the paper. Error: as generate_field.
[[nodiscard]] Result<FieldTargets> make_targets(const FieldCase& field, const RowParameters& row,
                                                std::uint64_t seed);

}  // namespace furrow::experiments
