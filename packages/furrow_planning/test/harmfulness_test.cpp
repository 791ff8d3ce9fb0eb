#include "furrow_planning/harmfulness.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace furrow::planning {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Harmfulness, FollowsTheEquation) {
  // A weed of 500 mm2 with beta 0.8, 0.2 m from a crop of 4000 mm2: 400 / 800 per metre.
  EXPECT_DOUBLE_EQ(harmfulness(500.0, 0.8, 4000.0, 0.2).value(), 0.5);
}

TEST(Harmfulness, RefusesBadNumbers) {
  EXPECT_FALSE(harmfulness(kNan, 0.8, 4000.0, 0.2).ok());
  EXPECT_FALSE(harmfulness(-1.0, 0.8, 4000.0, 0.2).ok());
  EXPECT_FALSE(harmfulness(500.0, -0.8, 4000.0, 0.2).ok());
  EXPECT_FALSE(harmfulness(500.0, 0.8, 0.0, 0.2).ok());
  EXPECT_FALSE(harmfulness(500.0, 0.8, 4000.0, 0.0).ok());
  EXPECT_FALSE(harmfulness(500.0, 0.8, 4000.0, kNan).ok());
}

HarmfulnessParameters kappa_parameters() {
  HarmfulnessParameters parameters;
  parameters.scheme = "kappa";
  parameters.species = {"thistle", "dicot"};
  parameters.beta = {1.0, 0.25};
  parameters.class_weight = {1.0, 0.1};
  return parameters;
}

TEST(HarmfulnessModel, NearestCropOrAllOfThem) {
  const CropPhenotype crops[] = {{{0.1, 0.0}, 1000.0}, {{0.0, -0.2}, 2000.0}, {{3.0, 0.0}, 1.0}};
  const WeedPhenotype weed{"thistle", {0.0, 0.0}, 300.0};
  auto parameters = kappa_parameters();
  const double nearest = 300.0 / (1000.0 * 0.1);
  const double second = 300.0 / (2000.0 * 0.2);
  EXPECT_DOUBLE_EQ(HarmfulnessModel(parameters).weigh(weed, crops)->weight, nearest);
  parameters.crops = "all";
  EXPECT_DOUBLE_EQ(HarmfulnessModel(parameters).weigh(weed, crops)->weight, nearest + second);
}

TEST(HarmfulnessModel, WithoutCropsAndOnTopOfOne) {
  const auto parameters = kappa_parameters();
  const HarmfulnessModel model(parameters);
  const WeedPhenotype weed{"dicot", {0.0, 0.0}, 200.0};
  EXPECT_DOUBLE_EQ(model.weigh(weed, {})->weight, 200.0 * 0.25 / (5000.0 * 0.5));
  const CropPhenotype crop{{0.0, 0.0}, 0.0};
  EXPECT_DOUBLE_EQ(model.weigh(weed, {&crop, 1})->weight, 200.0 * 0.25 / (5000.0 * 0.01));
}

TEST(HarmfulnessModel, ClassWeightsAndThreshold) {
  auto parameters = kappa_parameters();
  parameters.scheme = "class";
  parameters.left_standing_below = 0.5;
  const HarmfulnessModel model(parameters);
  const auto high = model.weigh({"thistle", {0.0, 0.0}, 10.0}, {}).value();
  const auto low = model.weigh({"dicot", {0.0, 0.0}, 10.0}, {}).value();
  EXPECT_DOUBLE_EQ(high.weight, 1.0);
  EXPECT_FALSE(high.leave);
  EXPECT_DOUBLE_EQ(low.weight, 0.1);
  EXPECT_TRUE(low.leave);
}

TEST(HarmfulnessModel, UnknownSpeciesFollowsItsPolicy) {
  const WeedPhenotype unknown{"", {0.0, 0.0}, 10.0};
  auto parameters = kappa_parameters();
  parameters.scheme = "class";
  EXPECT_DOUBLE_EQ(HarmfulnessModel(parameters).weigh(unknown, {})->weight, 1.0);
  parameters.unknown_species = "low";
  EXPECT_DOUBLE_EQ(HarmfulnessModel(parameters).weigh(unknown, {})->weight, 0.1);
  parameters.unknown_species = "leave";
  EXPECT_TRUE(HarmfulnessModel(parameters).weigh(unknown, {})->leave);
}

TEST(HarmfulnessModel, UniformIsOneForAll) {
  HarmfulnessParameters parameters;
  parameters.scheme = "uniform";
  EXPECT_DOUBLE_EQ(HarmfulnessModel(parameters).weigh({"dicot", {0, 0}, 1.0}, {})->weight, 1.0);
}

TEST(HarmfulnessModel, RefusesBadInput) {
  const HarmfulnessModel model(kappa_parameters());
  EXPECT_FALSE(model.weigh({"dicot", {kNan, 0.0}, 1.0}, {}).ok());
  EXPECT_FALSE(model.weigh({"dicot", {0.0, 0.0}, -1.0}, {}).ok());
  const CropPhenotype crop{{0.0, kNan}, 1.0};
  EXPECT_FALSE(model.weigh({"dicot", {0.0, 0.0}, 1.0}, {&crop, 1}).ok());
  auto parameters = kappa_parameters();
  parameters.beta.pop_back();
  EXPECT_THROW(HarmfulnessModel{parameters}, ConfigError);
  parameters = kappa_parameters();
  parameters.species[1] = "thistle";
  EXPECT_THROW(HarmfulnessModel{parameters}, ConfigError);
}

}  // namespace
}  // namespace furrow::planning
