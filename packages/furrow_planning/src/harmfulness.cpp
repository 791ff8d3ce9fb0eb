#include "furrow_planning/harmfulness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <utility>

#include "furrow_core/distribution.hpp"

namespace furrow::planning {
namespace {

constexpr double kPossible = 0.05;  // a species of less does not count as the worst possible

}  // namespace

Result<double> harmfulness(double weed_area_mm2, double beta, double crop_area_mm2,
                           double distance_m) {
  const double kappa = weed_area_mm2 * beta / (crop_area_mm2 * distance_m);
  if (!(weed_area_mm2 >= 0.0) || !(beta >= 0.0) || !(crop_area_mm2 > 0.0) || !(distance_m > 0.0) ||
      !std::isfinite(kappa)) {
    return Error{ErrorCode::kInvalidArgument,
                 "harmfulness needs finite areas and distance, of the crop above zero"};
  }
  return kappa;
}

void HarmfulnessParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "scheme",
           .description = "worth of a weed: all alike, by the class of its species, or kappa",
           .choices = {"uniform", "class", "kappa"}},
          scheme);
  v.visit({.name = "crops",
           .description = "kappa counts the nearest crop, or the sum over all crops in range",
           .choices = {"nearest", "all"}},
          crops);
  v.visit({.name = "crop_range_m",
           .unit = "m",
           .description = "crops farther from the weed do not count",
           .min = 0.01,
           .max = 10.0},
          crop_range_m);
  v.visit({.name = "min_distance_m",
           .unit = "m",
           .description = "smaller distances between weed and crop count as this",
           .min = 1e-4,
           .max = 1.0},
          min_distance_m);
  v.visit({.name = "no_crop_distance_m",
           .unit = "m",
           .description = "distance that stands for a crop where none is in range",
           .min = 1e-4,
           .max = 100.0},
          no_crop_distance_m);
  v.visit({.name = "no_crop_area_mm2",
           .unit = "mm2",
           .description = "area of a crop that is not there or has no area of its own",
           .min = 1.0,
           .max = 1e7},
          no_crop_area_mm2);
  v.visit({.name = "left_standing_below",
           .description = "weeds of less worth are left standing",
           .min = 0.0},
          left_standing_below);
  v.visit({.name = "unknown_species",
           .description = "a species that is not in the table: treat with the highest beta and "
                          "class weight, with the lowest, or leave standing",
           .choices = {"high", "low", "leave"}},
          unknown_species);
  v.visit({.name = "caution",
           .description = "0: the expected beta and class weight over the species; 1: those of the "
                          "worst species that the weed may be",
           .min = 0.0,
           .max = 1.0},
          caution);
  v.visit({.name = "species", .description = "names of the species table"}, species);
  v.visit({.name = "beta", .description = "factor of each species in kappa", .min = 0.0}, beta);
  v.visit({.name = "class_weight",
           .description = "worth of each species under the scheme class",
           .min = 0.0},
          class_weight);
}

HarmfulnessModel::HarmfulnessModel(HarmfulnessParameters parameters)
    : parameters_(std::move(parameters)) {
  const auto& names = parameters_.species;
  if (names.empty() || names.size() != parameters_.beta.size() ||
      names.size() != parameters_.class_weight.size()) {
    throw ConfigError("species, beta and class_weight are not equally long lists with an entry");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw ConfigError("species '" + names[i] + "' is named twice");
    }
    if (!(parameters_.beta[i] >= 0.0) || !(parameters_.class_weight[i] >= 0.0)) {
      throw ConfigError("beta and class_weight of '" + names[i] + "' must not be negative");
    }
  }
  const bool high = parameters_.unknown_species == "high";
  const auto pick = [high](const std::vector<double>& values) {
    return high ? *std::max_element(values.begin(), values.end())
                : *std::min_element(values.begin(), values.end());
  };
  unknown_ = {pick(parameters_.beta), pick(parameters_.class_weight)};
}

HarmfulnessModel::Factors HarmfulnessModel::factors(std::span<const SpeciesShare> distribution,
                                                    double& unknown) const {
  Factors expected;
  Factors worst;
  const auto add = [&](double probability, double beta, double class_weight) {
    expected.beta += probability * beta;
    expected.class_weight += probability * class_weight;
    if (probability < kPossible) return;
    worst.beta = std::max(worst.beta, beta);
    worst.class_weight = std::max(worst.class_weight, class_weight);
  };
  double known = 0.0;
  const auto& names = parameters_.species;
  for (const SpeciesShare& share : distribution) {
    const auto found = std::find(names.begin(), names.end(), share.species);
    if (found == names.end()) continue;
    const auto i = static_cast<std::size_t>(found - names.begin());
    add(share.probability, parameters_.beta[i], parameters_.class_weight[i]);
    known += share.probability;
  }
  unknown = std::max(1.0 - known, 0.0);
  add(unknown, unknown_.beta, unknown_.class_weight);
  const double q = parameters_.caution;
  return {(1.0 - q) * expected.beta + q * worst.beta,
          (1.0 - q) * expected.class_weight + q * worst.class_weight};
}

Result<Harmfulness> HarmfulnessModel::weigh(const WeedPhenotype& weed,
                                            std::span<const CropPhenotype> crops) const {
  const auto sound = [](const Eigen::Vector2d& p, double area) {
    return p.allFinite() && std::isfinite(area) && area >= 0.0;
  };
  if (!sound(weed.p_F, weed.area_mm2) ||
      !std::all_of(crops.begin(), crops.end(),
                   [&](const CropPhenotype& crop) { return sound(crop.p_F, crop.area_mm2); })) {
    return Error{ErrorCode::kInvalidArgument,
                 "a plant's position or area is not finite, or its area is negative"};
  }
  const SpeciesShare only{weed.species, 1.0};
  const auto distribution =
      weed.distribution.empty() ? std::span<const SpeciesShare>(&only, 1) : weed.distribution;
  if (!is_distribution(distribution | std::views::transform(&SpeciesShare::probability))) {
    return Error{ErrorCode::kInvalidArgument,
                 "a weed's probabilities of species are not in [0, 1], or their sum is above 1"};
  }
  double unknown = 0.0;
  const Factors by_species = factors(distribution, unknown);
  Harmfulness result{.beta = by_species.beta,
                     .class_weight = by_species.class_weight,
                     .unknown_probability = unknown};
  for (const SpeciesShare& share : distribution) {
    if (share.species.empty() || !(share.probability > result.species_probability)) continue;
    result.species = share.species;
    result.species_probability = share.probability;
  }
  set_proximity(weed, crops, result);
  if (parameters_.scheme == "uniform") {
    result.weight = 1.0;
  } else if (parameters_.scheme == "class") {
    result.weight = result.class_weight;
  } else {
    result.weight = weed.area_mm2 * result.beta * result.crop_proximity;
  }
  result.leave = (parameters_.unknown_species == "leave" && unknown > 0.5) ||
                 result.weight < parameters_.left_standing_below;
  return result;
}

void HarmfulnessModel::set_proximity(const WeedPhenotype& weed,
                                     std::span<const CropPhenotype> crops,
                                     Harmfulness& result) const {
  result.crop_distance_m = std::numeric_limits<double>::infinity();
  double of_nearest = 0.0;
  double of_all = 0.0;
  for (const CropPhenotype& crop : crops) {
    const double distance_m = (crop.p_F - weed.p_F).norm();
    if (distance_m > parameters_.crop_range_m) continue;
    const double area_mm2 = crop.area_mm2 > 0.0 ? crop.area_mm2 : parameters_.no_crop_area_mm2;
    const double value = 1.0 / (area_mm2 * std::max(distance_m, parameters_.min_distance_m));
    of_all += value;
    if (distance_m < result.crop_distance_m) {
      result.crop_distance_m = distance_m;
      of_nearest = value;
    }
  }
  if (!std::isfinite(result.crop_distance_m)) {
    of_nearest = 1.0 / (parameters_.no_crop_area_mm2 * parameters_.no_crop_distance_m);
    of_all = of_nearest;
  }
  result.crop_proximity = parameters_.crops == "all" ? of_all : of_nearest;
}

}  // namespace furrow::planning
