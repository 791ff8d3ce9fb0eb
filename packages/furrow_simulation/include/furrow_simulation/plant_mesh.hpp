#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_field/species.hpp"

namespace furrow::simulation {

/// How a plant of this species is drawn. A name that the table does not hold is drawn as kBeet for
/// a crop, and as kBroadleaf for a weed.
[[nodiscard]] field::LeafForm leaf_form(const field::SpeciesTable& species,
                                        const field::Plant& plant);

/// How plants look, beyond their form.
struct PlantParameters {
  double leaf_hue = 0.0;
  double leaf_brightness = 1.0;
  double leaf_variation = 0.5;
  double leaf_gloss = 0.5;
  double leaf_curl = 0.5;
  double leaf_damage = 0.1;
  double form_variation = 0.0;
  double plant_height_scale = 1.0;
  double leaf_sway_m = 0.0;

  void visit(ParameterVisitor& v);
};

/// A corner of a plant's mesh.
struct PlantVertex {
  Eigen::Vector3f p_P;  ///< in P: origin at the stem on the ground, axes along F's
  Eigen::Vector3f normal_P = Eigen::Vector3f::UnitZ();
  Eigen::Vector2f leaf = Eigen::Vector2f::Zero();  ///< along the blade in [0, 1]; across, [-1, 1]
  Eigen::Vector3f albedo_rgb = Eigen::Vector3f::Zero();  ///< linear
};

struct PlantMesh {
  std::vector<PlantVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double top_area_mm2 = 0.0;  ///< of the silhouette seen from straight above
  double radius_m = 0.0;      ///< largest horizontal distance of a vertex from the stem
  double height_m = 0.0;
};

/// The plant of the given seed: leaves, heading and size as `plant` says. The mesh's radius follows
/// Plant::radius_m, then its blades' width is chosen so that the area seen from above comes near
/// Plant::area_mm2. A radius or an area that is not positive follows from the other one; with
/// neither, the radius is 10 mm. Leaves are bounded to [2, 16], radii to [2, 400] mm.
[[nodiscard]] PlantMesh build_plant_mesh(const field::Plant& plant, field::LeafForm form,
                                         const PlantParameters& parameters, std::uint64_t seed);

/// A bound on the radius of a plant's mesh; its height is at most 1.1 times that.
[[nodiscard]] double max_mesh_radius_m(const field::Plant& plant);

/// The area of the mesh's silhouette from straight above, by rasterization.
[[nodiscard]] double top_view_area_mm2(const PlantMesh& mesh);

}  // namespace furrow::simulation
