#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"

namespace furrow::planning {

/// kappa(w, p) of a weed on one crop plant, in 1/m (Ahmadi et al. 2024, eq. harmfulnessCoef):
/// area_w * beta_w / (area_p * distance). Areas in mm2, distance in m. Error when a value is not
/// finite, beta or the weed's area is negative, or the crop's area or distance is not positive.
[[nodiscard]] Result<double> harmfulness(double weed_area_mm2, double beta, double crop_area_mm2,
                                         double distance_m);

struct HarmfulnessParameters {
  std::string scheme = "class";
  std::string crops = "nearest";
  double crop_range_m = 0.5;
  double min_distance_m = 0.01;
  double no_crop_distance_m = 0.5;
  double no_crop_area_mm2 = 5000.0;
  double left_standing_below = 0.0;
  std::string unknown_species = "high";
  double caution = 0.0;
  std::vector<std::string> species = {"barnyardgrass", "pigweed",   "lambsquarters", "thistle",
                                      "bindweed",      "grass",     "broadleaf",     "chamomile",
                                      "speedwell",     "chickweed", "dicot"};
  std::vector<double> beta = {1.0, 1.0, 1.0, 1.0, 0.9, 0.9, 0.7, 0.5, 0.2, 0.3, 0.3};
  std::vector<double> class_weight = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.1, 0.1, 0.1};

  void visit(ParameterVisitor& v);
};

struct SpeciesShare {
  std::string_view species;
  double probability = 0.0;
};

struct WeedPhenotype {
  std::string_view species;  ///< empty: not known
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  double area_mm2 = 0.0;
  /// Probabilities of species given that it is a weed, each named once. The rest to 1 is of unknown
  /// species. Used instead of `species` unless empty.
  std::span<const SpeciesShare> distribution = {};
};

struct CropPhenotype {
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  double area_mm2 = 0.0;
};

/// The worth of treating a weed, and what it was computed from.
struct Harmfulness {
  /// Of scheme uniform 1, of class class_weight, of kappa area x beta x crop_proximity.
  double weight = 0.0;
  bool leave = false;         ///< below the threshold, or an unknown species under policy "leave"
  double beta = 0.0;          ///< expected over the species, with caution
  double class_weight = 0.0;  ///< likewise
  std::string_view species;   ///< the most probable one; empty: none of more than nothing
  double species_probability = 0.0;
  double unknown_probability = 0.0;  ///< of species that the table does not have
  double crop_distance_m = 0.0;      ///< to the nearest crop in range; infinite: none
  double crop_proximity = 0.0;       ///< sum of 1 / (crop area x distance), in 1/(mm2 m)
};

/// Weighs weeds by the chosen scheme: "uniform" (all 1), "class" (by species: the paper's 0.1 and
/// 1.0), "kappa" (by species, area and the crops near it).
///
/// Under a distribution over species, beta and class weight are x = (1 - q) E[x] + q max x, with
/// q = caution. The maximum is over species of at least 5 %. Species that are not in the table
/// count by the policy unknown_species; "leave" leaves the weed where they hold more than half.
class HarmfulnessModel {
 public:
  /// Throws ConfigError when the lists of species, beta and class_weight differ in length or a
  /// species is named twice.
  explicit HarmfulnessModel(HarmfulnessParameters parameters);

  /// Error when a position or area is not finite, an area is negative, or a distribution has a
  /// value outside [0, 1] or a sum above 1. Crops without an area count with no_crop_area_mm2.
  [[nodiscard]] Result<Harmfulness> weigh(const WeedPhenotype& weed,
                                          std::span<const CropPhenotype> crops) const;
  [[nodiscard]] const HarmfulnessParameters& parameters() const { return parameters_; }

 private:
  struct Factors {
    double beta = 0.0;
    double class_weight = 0.0;
  };
  [[nodiscard]] Factors factors(std::span<const SpeciesShare> distribution, double& unknown) const;
  void set_proximity(const WeedPhenotype& weed, std::span<const CropPhenotype> crops,
                     Harmfulness& result) const;
  HarmfulnessParameters parameters_;
  Factors unknown_;  ///< by the policy
};

}  // namespace furrow::planning
