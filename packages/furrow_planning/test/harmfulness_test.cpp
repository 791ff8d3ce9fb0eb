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

TEST(HarmfulnessModel, ExpectsOverTheSpecies) {
  // beta 1.0 and 0.25, class weight 1.0 and 0.1; no crop in range: area / (5000 * 0.5).
  const SpeciesShare shares[] = {{"thistle", 0.2}, {"dicot", 0.8}};
  const WeedPhenotype weed{"", {0.0, 0.0}, 500.0, shares};
  auto parameters = kappa_parameters();
  const double beta = 0.2 * 1.0 + 0.8 * 0.25;
  const auto expected = HarmfulnessModel(parameters).weigh(weed, {}).value();
  EXPECT_NEAR(expected.beta, beta, 1e-12);
  EXPECT_NEAR(expected.weight, 500.0 * beta / 2500.0, 1e-12);
  parameters.scheme = "class";
  EXPECT_NEAR(HarmfulnessModel(parameters).weigh(weed, {})->weight, 0.2 + 0.08, 1e-12);
}

TEST(HarmfulnessModel, CautionTakesTheWorstPossibleSpecies) {
  auto parameters = kappa_parameters();
  parameters.scheme = "class";
  parameters.caution = 1.0;
  const SpeciesShare possible[] = {{"thistle", 0.06}, {"dicot", 0.94}};
  const SpeciesShare improbable[] = {{"thistle", 0.04}, {"dicot", 0.96}};
  const HarmfulnessModel model(parameters);
  EXPECT_DOUBLE_EQ(model.weigh({"", {0.0, 0.0}, 1.0, possible}, {})->weight, 1.0);
  EXPECT_DOUBLE_EQ(model.weigh({"", {0.0, 0.0}, 1.0, improbable}, {})->weight, 0.1);
}

TEST(HarmfulnessModel, TheUnknownShareFollowsItsPolicy) {
  // 0.6 dicot, 0.4 unknown; a name that is not in the table counts as unknown.
  const SpeciesShare shares[] = {{"dicot", 0.6}, {"triffid", 0.1}};
  const WeedPhenotype weed{"", {0.0, 0.0}, 1.0, shares};
  auto parameters = kappa_parameters();
  parameters.scheme = "class";
  EXPECT_NEAR(HarmfulnessModel(parameters).weigh(weed, {})->weight, 0.06 + 0.4, 1e-12);
  parameters.unknown_species = "low";
  EXPECT_NEAR(HarmfulnessModel(parameters).weigh(weed, {})->weight, 0.1, 1e-12);
  parameters.unknown_species = "leave";
  EXPECT_FALSE(HarmfulnessModel(parameters).weigh(weed, {})->leave);
  const SpeciesShare unsure[] = {{"dicot", 0.4}};
  EXPECT_TRUE(HarmfulnessModel(parameters).weigh({"", {0.0, 0.0}, 1.0, unsure}, {})->leave);
}

TEST(HarmfulnessModel, RefusesWhatIsNoDistribution) {
  const HarmfulnessModel model(kappa_parameters());
  for (const double bad : {-0.1, 1.1, kNan}) {
    const SpeciesShare shares[] = {{"dicot", bad}};
    EXPECT_FALSE(model.weigh({"", {0.0, 0.0}, 1.0, shares}, {}).ok()) << bad;
  }
  const SpeciesShare shares[] = {{"dicot", 0.9}, {"thistle", 0.9}};
  EXPECT_FALSE(model.weigh({"", {0.0, 0.0}, 1.0, shares}, {}).ok());
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
