#pragma once

#include "furrow_core/random.hpp"
#include "furrow_simulation/plant_mesh.hpp"

namespace furrow::simulation {

/// What the shape of one plant depends on.
struct PlantShape {
  field::LeafForm form = field::LeafForm::kBeet;
  int leaves = 2;
  float heading_rad = 0.0f;
  float stalk_width = 0.0f;  ///< at least
  float blade_width = 1.0f;  ///< factor on the usual width of the form's blades
};

/// Builds the leaves of a form at an arbitrary scale of about 1, the stem at the origin.
void build_form(PlantMesh& mesh, const PlantShape& shape, const PlantParameters& parameters,
                Random random);

}  // namespace furrow::simulation
