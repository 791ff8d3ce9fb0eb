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
  std::vector<std::string> species = {"barnyardgrass", "pigweed",   "lambsquarters", "thistle",
                                      "bindweed",      "grass",     "broadleaf",     "chamomile",
                                      "speedwell",     "chickweed", "dicot"};
  std::vector<double> beta = {1.0, 1.0, 1.0, 1.0, 0.9, 0.9, 0.7, 0.5, 0.2, 0.3, 0.3};
  std::vector<double> class_weight = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.1, 0.1, 0.1};

  void visit(ParameterVisitor& v);
};

struct WeedPhenotype {
  std::string_view species;  ///< empty: not known
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  double area_mm2 = 0.0;
};

struct CropPhenotype {
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  double area_mm2 = 0.0;
};

/// The worth of treating a weed.
struct Harmfulness {
  double weight = 0.0;
  bool leave = false;  ///< below the threshold, or an unknown species under the policy "leave"
};

/// Weighs weeds by the chosen scheme: "uniform" (all 1), "class" (by species: the paper's 0.1 and
/// 1.0), "kappa" (by species, area and the crops near it).
class HarmfulnessModel {
 public:
  /// Throws ConfigError when the lists of species, beta and class_weight differ in length or a
  /// species is named twice.
  explicit HarmfulnessModel(HarmfulnessParameters parameters);

  /// Error when a position or area is not finite, or an area is negative. Crops without an area
  /// count with no_crop_area_mm2.
  [[nodiscard]] Result<Harmfulness> weigh(const WeedPhenotype& weed,
                                          std::span<const CropPhenotype> crops) const;
  [[nodiscard]] const HarmfulnessParameters& parameters() const { return parameters_; }

 private:
  [[nodiscard]] double kappa(const WeedPhenotype& weed, double beta,
                             std::span<const CropPhenotype> crops) const;
  HarmfulnessParameters parameters_;
};

}  // namespace furrow::planning
