#include "furrow_vision/growth_stage.hpp"

#include "furrow_core/error.hpp"

namespace furrow::vision {

std::string_view to_string(GrowthStage stage) {
  switch (stage) {
    case GrowthStage::kCotyledon:
      return "cotyledon";
    case GrowthStage::kTwoLeaves:
      return "two_leaves";
    case GrowthStage::kFourLeaves:
      return "four_leaves";
    case GrowthStage::kSixLeaves:
      return "six_leaves";
    case GrowthStage::kEightLeaves:
      return "eight_leaves";
  }
  return "unknown";
}

int leaf_count(GrowthStage stage) {
  return 2 * static_cast<int>(stage);
}

void GrowthStageParameters::visit(ParameterVisitor& v) {
  const auto area = [&](const char* name, const char* stage, double& value) {
    v.visit(
        {.name = name,
         .unit = "mm2",
         .description = std::string("Least leaf area of a plant with ") + stage + " true leaves",
         .min = 0.1,
         .max = 1e7},
        value);
  };
  area("two_leaves_mm2", "two", two_leaves_mm2);
  area("four_leaves_mm2", "four", four_leaves_mm2);
  area("six_leaves_mm2", "six", six_leaves_mm2);
  area("eight_leaves_mm2", "eight", eight_leaves_mm2);
}

GrowthStageEstimator::GrowthStageEstimator(const GrowthStageParameters& parameters)
    : parameters_(parameters) {
  validate_parameters(parameters_);
  const auto& p = parameters_;
  if (!(p.two_leaves_mm2 > 0.0 && p.four_leaves_mm2 > p.two_leaves_mm2 &&
        p.six_leaves_mm2 > p.four_leaves_mm2 && p.eight_leaves_mm2 > p.six_leaves_mm2)) {
    throw ConfigError("growth stage: the areas must increase from two to eight leaves");
  }
}

GrowthStage GrowthStageEstimator::stage(double area_mm2) const {
  if (area_mm2 >= parameters_.eight_leaves_mm2) return GrowthStage::kEightLeaves;
  if (area_mm2 >= parameters_.six_leaves_mm2) return GrowthStage::kSixLeaves;
  if (area_mm2 >= parameters_.four_leaves_mm2) return GrowthStage::kFourLeaves;
  if (area_mm2 >= parameters_.two_leaves_mm2) return GrowthStage::kTwoLeaves;
  return GrowthStage::kCotyledon;
}

}  // namespace furrow::vision
