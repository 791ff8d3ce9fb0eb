#include "furrow_simulation/plant_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "furrow_core/random.hpp"
#include "leaf.hpp"
#include "plant_forms.hpp"
#include "raster.hpp"

namespace furrow::simulation {
namespace {

// Thinner stalks would fall between the pixels.
constexpr double kMinStalk_m = 0.0011;
// The canopy's height may not exceed this share of its radius.
constexpr float kMaxHeightShare = 1.1f;
// How far a radius may give way to the area.
constexpr double kMaxRescale = 1.25;

bool is_given(double value) {
  return value > 0.0 && std::isfinite(value);
}

double nominal_radius_m(const field::Plant& plant) {
  constexpr double kFill = 0.45;  // the share of its circle that a canopy covers
  double radius_m = 0.010;
  if (is_given(plant.radius_m)) {
    radius_m = plant.radius_m;
  } else if (is_given(plant.area_mm2)) {
    radius_m = 1e-3 * std::sqrt(plant.area_mm2 / (kFill * std::numbers::pi));
  }
  return std::clamp(radius_m, 0.002, 0.4);
}

void scale_to_radius(PlantMesh& mesh, float radius_m, float height_scale) {
  float extent = 1e-9f;
  for (const auto& v : mesh.vertices) extent = std::max(extent, v.p_P.head<2>().norm());
  const float scale = radius_m / extent;
  for (auto& v : mesh.vertices) {
    v.p_P.head<2>() *= scale;
    v.p_P.z() = std::clamp(v.p_P.z() * scale * height_scale, 0.0005f, kMaxHeightShare * radius_m);
  }
}

}  // namespace

field::LeafForm leaf_form(const field::SpeciesTable& species, const field::Plant& plant) {
  if (const field::Species* entry = species.find(plant.species)) return entry->leaf_form;
  return plant.kind == field::PlantKind::kCrop ? field::LeafForm::kBeet
                                               : field::LeafForm::kBroadleaf;
}

void PlantParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "leaf_hue",
           .description = "of all leaves: -1 bluish green, 1 yellowish green",
           .min = -1.0,
           .max = 1.0},
          leaf_hue);
  v.visit({.name = "leaf_brightness", .description = "of all leaves", .min = 0.4, .max = 1.6},
          leaf_brightness);
  v.visit({.name = "leaf_variation",
           .description = "of colour between plants and leaves",
           .min = 0.0,
           .max = 2.0},
          leaf_variation);
  v.visit(
      {.name = "leaf_gloss", .description = "of the leaves' upper side", .min = 0.0, .max = 1.0},
      leaf_gloss);
  v.visit({.name = "leaf_curl",
           .description = "how much leaves droop and undulate",
           .min = 0.0,
           .max = 1.0},
          leaf_curl);
  v.visit({.name = "leaf_damage", .description = "yellowing and spots", .min = 0.0, .max = 1.0},
          leaf_damage);
  v.visit({.name = "form_variation",
           .description = "of proportions, outlines and habit between plants of one species; 0: "
                          "each species has one form",
           .min = 0.0,
           .max = 1.0},
          form_variation);
  v.visit(
      {.name = "plant_height_scale", .description = "upright against flat", .min = 0.1, .max = 2.0},
      plant_height_scale);
  v.visit({.name = "leaf_sway_m",
           .unit = "m",
           .description = "standard deviation of the wind's sway at 50 mm above the ground, in "
                          "each direction, anew in each frame; stems stay, shadows too",
           .min = 0.0,
           .max = 0.1},
          leaf_sway_m);
}

double max_mesh_radius_m(const field::Plant& plant) {
  return kMaxRescale * nominal_radius_m(plant);
}

double top_view_area_mm2(const PlantMesh& mesh) {
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector2f high = -low;
  for (const auto& v : mesh.vertices) {
    low = low.cwiseMin(v.p_P.head<2>());
    high = high.cwiseMax(v.p_P.head<2>());
  }
  if (mesh.triangles.empty()) return 0.0;
  constexpr int kGrid = 192;
  const float cell = std::max((high - low).maxCoeff() / static_cast<float>(kGrid - 2), 1e-6f);
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(kGrid) * kGrid, 0);
  const auto place = [&](std::uint32_t i) {
    return Eigen::Vector2f((mesh.vertices[i].p_P.head<2>() - low) / cell +
                           Eigen::Vector2f::Constant(0.5f));
  };
  for (const auto& t : mesh.triangles) {
    scan_triangle(place(t[0]), place(t[1]), place(t[2]), kGrid, 0, kGrid,
                  [&](int y, int first, int end) {
                    const auto row = mask.begin() + static_cast<std::ptrdiff_t>(y) * kGrid;
                    std::fill(row + first, row + end, std::uint8_t{1});
                  });
  }
  const auto covered = static_cast<double>(std::count(mask.begin(), mask.end(), 1));
  return 1e6 * covered * cell * cell;
}

PlantMesh build_plant_mesh(const field::Plant& plant, field::LeafForm form,
                           const PlantParameters& parameters, std::uint64_t seed) {
  const double radius_m = nominal_radius_m(plant);
  const bool has_area = is_given(plant.area_mm2);
  PlantMesh mesh;
  PlantShape shape;
  shape.form = form;
  shape.stalk_width = static_cast<float>(kMinStalk_m / radius_m);
  shape.leaves = std::clamp(plant.leaves, 2, 16);
  shape.heading_rad =
      std::isfinite(plant.heading_rad) ? static_cast<float>(plant.heading_rad) : 0.0f;
  const Random random(seed, "plant", static_cast<std::uint64_t>(plant.id));
  const auto height_scale = static_cast<float>(parameters.plant_height_scale);
  const auto rebuild = [&] {
    build_form(mesh, shape, parameters, random);
    scale_to_radius(mesh, static_cast<float>(radius_m), height_scale);
    mesh.top_area_mm2 = top_view_area_mm2(mesh);
  };
  rebuild();
  if (has_area) {
    for (int pass = 0; pass < 2; ++pass) {
      const double ratio = plant.area_mm2 / std::max(mesh.top_area_mm2, 1e-3);
      if (std::abs(ratio - 1.0) < 0.05) break;
      shape.blade_width = std::clamp(shape.blade_width * static_cast<float>(ratio), 0.5f, 1.55f);
      rebuild();
    }
    // What the blades' width cannot give, a slightly different radius does.
    const double ratio = std::sqrt(plant.area_mm2 / std::max(mesh.top_area_mm2, 1e-3));
    const auto scale = static_cast<float>(std::clamp(ratio, 1.0 / kMaxRescale, kMaxRescale));
    for (auto& v : mesh.vertices) v.p_P *= scale;
    mesh.top_area_mm2 *= static_cast<double>(scale) * scale;
  }
  for (const auto& v : mesh.vertices) {
    mesh.radius_m = std::max(mesh.radius_m, static_cast<double>(v.p_P.head<2>().norm()));
    mesh.height_m = std::max(mesh.height_m, static_cast<double>(v.p_P.z()));
  }
  compute_normals(mesh);
  return mesh;
}

}  // namespace furrow::simulation
