#include "furrow_field/species.hpp"

namespace furrow::field {
namespace {

/// Constants, so that the table needs no code.
struct DefaultSpecies {
  const char* name;
  const char* botanical;
  PlantKind kind;
  GrowthForm growth_form;
  LeafForm leaf_form;
  struct {
    double beta, priority;
    bool beneficial;
  } harm;
  struct {
    double radius_two_leaves_m, radius_eight_leaves_m, leaf_cover;
  } canopy;
};

constexpr DefaultSpecies kDefaults[] = {
    {"sugar_beet",
     "Beta vulgaris",
     PlantKind::kCrop,
     GrowthForm::kBroadleaf,
     LeafForm::kBeet,
     {0.0, 0.0, false},
     {0.022, 0.085, 0.55}},
    {"lambsquarters",
     "Chenopodium album",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kLobed,
     {1.0, 1.0, false},
     {0.01, 0.045, 0.5}},
    {"pigweed",
     "Amaranthus retroflexus",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kBroadleaf,
     {1.0, 1.0, false},
     {0.01, 0.045, 0.5}},
    {"bindweed",
     "Fallopia convolvulus",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kBroadleaf,
     {0.9, 1.0, false},
     {0.012, 0.05, 0.4}},
    {"chickweed",
     "Stellaria media",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kRosette,
     {0.3, 0.1, true},
     {0.008, 0.04, 0.45}},
    {"barnyardgrass",
     "Echinochloa crus-galli",
     PlantKind::kWeed,
     GrowthForm::kGrass,
     LeafForm::kGrass,
     {1.0, 1.0, false},
     {0.018, 0.07, 0.2}},
    {"foxtail",
     "Setaria viridis",
     PlantKind::kWeed,
     GrowthForm::kGrass,
     LeafForm::kGrass,
     {0.9, 1.0, false},
     {0.016, 0.06, 0.2}},
    {"chamomile",
     "Matricaria chamomilla",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kFeathery,
     {0.5, 1.0, false},
     {0.008, 0.04, 0.3}},
    {"thistle",
     "Cirsium arvense",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kThistle,
     {1.0, 1.0, false},
     {0.015, 0.07, 0.45}},
    {"cleavers",
     "Galium aparine",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kWhorled,
     {0.8, 1.0, false},
     {0.01, 0.045, 0.35}},
    {"nightshade",
     "Solanum nigrum",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kBroadleaf,
     {0.7, 1.0, false},
     {0.01, 0.05, 0.5}},
    {"speedwell",
     "Veronica persica",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kRosette,
     {0.2, 0.1, true},
     {0.008, 0.035, 0.45}},
    {"violet",
     "Viola arvensis",
     PlantKind::kWeed,
     GrowthForm::kBroadleaf,
     LeafForm::kRosette,
     {0.2, 0.1, true},
     {0.008, 0.03, 0.45}},
};

}  // namespace

SpeciesTable SpeciesTable::defaults() {
  std::vector<Species> species;
  for (const DefaultSpecies& entry : kDefaults) {
    species.push_back({.name = entry.name,
                       .botanical = entry.botanical,
                       .kind = entry.kind,
                       .growth_form = entry.growth_form,
                       .leaf_form = entry.leaf_form,
                       .beta = entry.harm.beta,
                       .priority = entry.harm.priority,
                       .beneficial = entry.harm.beneficial,
                       .radius_two_leaves_m = entry.canopy.radius_two_leaves_m,
                       .radius_eight_leaves_m = entry.canopy.radius_eight_leaves_m,
                       .leaf_cover = entry.canopy.leaf_cover});
  }
  return SpeciesTable(std::move(species));
}

}  // namespace furrow::field
