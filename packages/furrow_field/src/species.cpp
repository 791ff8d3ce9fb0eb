#include "furrow_field/species.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "furrow_core/error.hpp"

namespace furrow::field {
namespace {

constexpr std::array<std::string_view, 2> kKinds = {"crop", "weed"};
constexpr std::array<std::string_view, 2> kGrowthForms = {"broadleaf", "grass"};
constexpr std::array<std::string_view, 9> kLeafForms = {"beet",    "broadleaf", "lobed",
                                                        "grass",   "feathery",  "trifoliate",
                                                        "rosette", "thistle",   "whorled"};

template <std::size_t n>
std::vector<std::string> strings(const std::array<std::string_view, n>& names) {
  return {names.begin(), names.end()};
}

/// Lets a visitor read and write an enum by its name. An unknown name leaves it unchanged.
template <class Enum, std::size_t n>
void visit_enum(ParameterVisitor& v, const char* name, const char* description,
                const std::array<std::string_view, n>& names, Enum& value) {
  std::string text(names.at(static_cast<std::size_t>(value)));
  v.visit({.name = name, .description = description, .choices = strings(names)}, text);
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) value = static_cast<Enum>(found - names.begin());
}

bool is_identifier(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

std::string_view to_string(GrowthForm form) {
  return kGrowthForms.at(static_cast<std::size_t>(form));
}

std::string_view to_string(LeafForm form) {
  return kLeafForms.at(static_cast<std::size_t>(form));
}

void Species::visit(ParameterVisitor& v) {
  v.visit({.name = "name", .description = "lower case, words joined by '_'"}, name);
  v.visit({.name = "botanical", .description = "botanical name"}, botanical);
  visit_enum(v, "kind", "crop or weed", kKinds, kind);
  visit_enum(v, "growth_form", "broadleaf (dicot) or grass", kGrowthForms, growth_form);
  visit_enum(v, "leaf_form", "how the plant is drawn", kLeafForms, leaf_form);
  v.visit({.name = "beta", .description = "harmfulness factor", .min = 0.0, .max = 1000.0}, beta);
  v.visit({.name = "priority", .description = "class weight in planning", .min = 0.0, .max = 1.0},
          priority);
  v.visit({.name = "beneficial", .description = "worth leaving where the crop does not suffer"},
          beneficial);
  v.visit({.name = "radius_two_leaves_m",
           .unit = "m",
           .description = "canopy radius with two leaves",
           .min = 0.001,
           .max = 1.0},
          radius_two_leaves_m);
  v.visit({.name = "radius_eight_leaves_m",
           .unit = "m",
           .description = "canopy radius with eight leaves",
           .min = 0.001,
           .max = 1.0},
          radius_eight_leaves_m);
  v.visit({.name = "leaf_cover",
           .description = "leaf area seen from above over the canopy's disc",
           .min = 0.01,
           .max = 1.0},
          leaf_cover);
}

double canopy_radius_m(const Species& species, int leaves) {
  const double stage = (std::clamp(leaves, 2, 8) - 2) / 6.0;
  return species.radius_two_leaves_m *
         std::pow(species.radius_eight_leaves_m / species.radius_two_leaves_m, stage);
}

double leaf_area_mm2(const Species& species, double radius_m) {
  return 1e6 * species.leaf_cover * std::numbers::pi * radius_m * radius_m;
}

SpeciesTable::SpeciesTable(std::vector<Species> species) : species_(std::move(species)) {
  std::set<std::string> seen;
  for (const Species& entry : species_) {
    const std::string key = "species '" + entry.name + "'";
    if (!is_identifier(entry.name)) {
      throw ConfigError({}, key, "a name has lower case letters, digits and '_' only");
    }
    if (!seen.insert(entry.name).second) throw ConfigError({}, key, "the name is there twice");
    try {
      validate_parameters(entry);
    } catch (const ConfigError& error) {
      throw ConfigError({}, key, error.what());
    }
  }
}

const Species* SpeciesTable::find(std::string_view name) const {
  const auto found = std::find_if(species_.begin(), species_.end(),
                                  [&](const Species& entry) { return entry.name == name; });
  return found == species_.end() ? nullptr : &*found;
}

std::vector<std::string> SpeciesTable::names(PlantKind kind) const {
  std::vector<std::string> result;
  for (const Species& entry : species_) {
    if (entry.kind == kind) result.push_back(entry.name);
  }
  return result;
}

}  // namespace furrow::field
