#pragma once

#include <string_view>

#include "furrow_core/parameters.hpp"

namespace furrow::vision {

enum class GrowthStage { kCotyledon, kTwoLeaves, kFourLeaves, kSixLeaves, kEightLeaves };

/// "cotyledon", "two_leaves", ...
[[nodiscard]] std::string_view to_string(GrowthStage stage);
/// True leaves at the stage: 0, 2, 4, 6, 8.
[[nodiscard]] int leaf_count(GrowthStage stage);

/// From which leaf area on a plant counts as being at a stage. Depends on the species; the defaults
/// are of the order of a small broad-leaved weed.
struct GrowthStageParameters {
  double two_leaves_mm2 = 120.0;
  double four_leaves_mm2 = 500.0;
  double six_leaves_mm2 = 1500.0;
  double eight_leaves_mm2 = 3500.0;
  void visit(ParameterVisitor& v);
};

class GrowthStageEstimator {
 public:
  /// Throws ConfigError when the areas do not increase strictly from a positive one.
  explicit GrowthStageEstimator(const GrowthStageParameters& parameters);
  /// Areas that are not finite or not positive count as cotyledon.
  [[nodiscard]] GrowthStage stage(double area_mm2) const;

 private:
  GrowthStageParameters parameters_;
};

}  // namespace furrow::vision
