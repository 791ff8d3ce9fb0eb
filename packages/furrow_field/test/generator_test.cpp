#include "furrow_field/generator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "field_test_support.hpp"
#include "furrow_field/statistics.hpp"
#include "plain_yaml.hpp"

namespace furrow::field {
namespace {

const SpeciesTable kSpecies = SpeciesTable::defaults();

FieldModel generate(const FieldParameters& parameters, std::uint64_t seed) {
  Result<FieldModel> field = generate_field(parameters, kSpecies, seed);
  EXPECT_TRUE(field.ok()) << field.error().message;
  const Status status = validate(*field);
  EXPECT_TRUE(status.ok()) << status.error().message;
  return std::move(*field);
}

Error error_of(const FieldParameters& parameters, const SpeciesTable& species = kSpecies) {
  const Result<FieldModel> field = generate_field(parameters, species, 1);
  return field.ok() ? Error{} : field.error();
}

/// Variance over mean of the weeds' numbers in square quadrats: 1 for a Poisson process.
double dispersion(const FieldModel& field, double side_m) {
  const auto nx = static_cast<int>(field.length_m / side_m);
  const auto ny = static_cast<int>(field.width_m / side_m);
  std::vector<double> counts(static_cast<std::size_t>(nx) * ny, 0.0);
  for (const Plant& plant : field.plants) {
    const auto ix = static_cast<int>(plant.p_F_m.x() / side_m);
    const auto iy = static_cast<int>((plant.p_F_m.y() + 0.5 * field.width_m) / side_m);
    if (ix < nx && iy < ny) counts[static_cast<std::size_t>(ix) * ny + iy] += 1.0;
  }
  double mean = 0.0;
  for (const double c : counts) mean += c;
  mean /= static_cast<double>(counts.size());
  double variance = 0.0;
  for (const double c : counts) variance += (c - mean) * (c - mean);
  return variance / static_cast<double>(counts.size() - 1) / mean;
}

TEST(Generator, SameSeedSameFieldOtherSeedAnother) {
  for (const char* pattern : {"poisson", "clusters"}) {
    const FieldParameters parameters{.pattern = pattern};
    const FieldModel field = generate(parameters, 7);
    expect_equal(field, generate(parameters, 7));
    const FieldModel other = generate(parameters, 8);
    ASSERT_FALSE(other.plants.empty());
    EXPECT_NE(field.plants.front().p_F_m, other.plants.front().p_F_m);
  }
}

TEST(Generator, SaysWhereTheFieldComesFrom) {
  const FieldModel field = generate({.weeds_per_m2 = 15.4, .crop = false}, 7);
  EXPECT_EQ(field.source, "generated: poisson, 15.4 weeds/m2, no crop, seed 7");
}

TEST(Generator, PoissonFieldHasTheDensityAndNoStructure) {
  const FieldParameters parameters{
      .length_m = 100.0, .width_m = 20.0, .weeds_per_m2 = 15.4, .crop = false};
  const FieldModel field = generate(parameters, 3);
  const double mean = 15.4 * 2000.0;
  EXPECT_NEAR(static_cast<double>(field.plants.size()), mean, 4.0 * std::sqrt(mean));
  // 2000 quadrats: the standard deviation of the index is sqrt(2 / 1999).
  EXPECT_NEAR(dispersion(field, 1.0), 1.0, 4.0 * std::sqrt(2.0 / 1999.0));
  EXPECT_TRUE(field.row_y_m.empty());
}

TEST(Generator, ClustersKeepTheDensityUpToTheEdges) {
  const FieldParameters parameters{.length_m = 100.0,
                                   .width_m = 20.0,
                                   .weeds_per_m2 = 15.4,
                                   .pattern = "clusters",
                                   .cluster_weeds = 5.0,
                                   .cluster_sd_m = 0.1,
                                   .crop = false};
  const FieldModel field = generate(parameters, 4);
  // The number's variance is that of a compound Poisson sum: mean * (1 + cluster_weeds).
  const double mean = 15.4 * 2000.0;
  EXPECT_NEAR(static_cast<double>(field.plants.size()), mean, 4.0 * std::sqrt(6.0 * mean));
  // Quadrats much larger than a cluster hold whole clusters: nearly 1 + cluster_weeds.
  EXPECT_GT(dispersion(field, 1.0), 4.0);
  EXPECT_LT(dispersion(field, 1.0), 7.0);
  const double border_area_m2 = 2.0 * 100.0 * 0.5;
  const auto border = std::count_if(field.plants.begin(), field.plants.end(),
                                    [](const Plant& p) { return std::abs(p.p_F_m.y()) > 9.5; });
  EXPECT_NEAR(static_cast<double>(border), 15.4 * border_area_m2,
              4.0 * std::sqrt(6.0 * 15.4 * border_area_m2));
}

TEST(Generator, CropStandsInRows) {
  FieldParameters parameters{.length_m = 200.0, .weeds_per_m2 = 0.0};
  const FieldModel field = generate(parameters, 5);
  ASSERT_EQ(field.row_y_m, (std::vector<double>{-0.5, 0.0, 0.5}));
  for (const double row_m : field.row_y_m) {
    std::vector<double> x_m;
    for (const Plant& plant : field.plants) {
      EXPECT_EQ(plant.species, "sugar_beet");
      if (std::abs(plant.p_F_m.y() - row_m) < 0.1) x_m.push_back(plant.p_F_m.x());
    }
    // 200 m / 0.19 m, less 5 % that did not come up.
    const double places = 200.0 / 0.19;
    EXPECT_NEAR(static_cast<double>(x_m.size()), 0.95 * places,
                4.0 * std::sqrt(0.05 * 0.95 * places) + 5.0);
    for (std::size_t i = 1; i < x_m.size(); ++i) EXPECT_GT(x_m[i] - x_m[i - 1], 0.4 * 0.19 - 1e-9);
  }
  parameters.row_offset_m = 0.25;
  EXPECT_EQ(generate(parameters, 5).row_y_m, (std::vector<double>{-0.25, 0.25}));
  parameters.missing_probability = 1.0;
  EXPECT_TRUE(generate(parameters, 5).plants.empty());
}

TEST(Generator, KeepsMinimumDistancesAndTheDensity) {
  for (const char* pattern : {"poisson", "clusters"}) {
    const FieldParameters parameters{.length_m = 40.0,
                                     .weeds_per_m2 = 22.3,
                                     .pattern = pattern,
                                     .weed_to_crop_min_m = 0.05,
                                     .weed_to_weed_min_m = 0.03};
    const FieldModel field = generate(parameters, 6);
    for (std::size_t i = 0; i < field.plants.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Plant& a = field.plants[i];
        const Plant& b = field.plants[j];
        if (a.kind == PlantKind::kCrop && b.kind == PlantKind::kCrop) continue;
        const bool weeds = a.kind == PlantKind::kWeed && b.kind == PlantKind::kWeed;
        EXPECT_GE((a.p_F_m - b.p_F_m).norm(), weeds ? 0.03 : 0.05);
      }
    }
    if (std::string(pattern) == "poisson") {
      const double mean = 22.3 * 40.0 * 1.39;
      EXPECT_NEAR(static_cast<double>(statistics_of(field).weeds), mean, 4.0 * std::sqrt(mean));
    }
  }
}

TEST(Generator, SpeciesFollowTheirShares) {
  const FieldParameters parameters{.length_m = 100.0,
                                   .width_m = 10.0,
                                   .weeds_per_m2 = 10.0,
                                   .weed_species = {"thistle", "violet", "foxtail"},
                                   .weed_shares = {1.0, 3.0, 0.0},
                                   .crop = false};
  const FieldStatistics statistics = statistics_of(generate(parameters, 9));
  ASSERT_EQ(statistics.by_species.size(), 2u);
  EXPECT_EQ(statistics.by_species[0].species, "violet");
  const double n = static_cast<double>(statistics.weeds);
  EXPECT_NEAR(static_cast<double>(statistics.by_species[0].plants), 0.75 * n,
              4.0 * std::sqrt(0.75 * 0.25 * n));
}

TEST(Generator, SizesFollowTheGrowthStage) {
  const FieldParameters parameters{.weeds_per_m2 = 20.0,
                                   .weed_species = {"thistle"},
                                   .weed_leaves_min = 4,
                                   .weed_leaves_max = 6,
                                   .crop = false,
                                   .size_sd = 0.0};
  const Species& thistle = *kSpecies.find("thistle");
  for (const Plant& plant : generate(parameters, 2).plants) {
    EXPECT_GE(plant.leaves, 4);
    EXPECT_LE(plant.leaves, 6);
    EXPECT_DOUBLE_EQ(plant.radius_m, canopy_radius_m(thistle, plant.leaves));
    EXPECT_DOUBLE_EQ(plant.area_mm2, leaf_area_mm2(thistle, plant.radius_m));
  }
}

TEST(Generator, TheCropDoesNotChangeTheWeedsWhereTheyHaveRoom) {
  FieldParameters parameters{.weed_to_crop_min_m = 0.0};
  const FieldModel both = generate(parameters, 11);
  parameters.crop = false;
  const FieldModel weeds = generate(parameters, 11);
  std::vector<Plant> left;
  for (const Plant& plant : both.plants) {
    if (plant.kind == PlantKind::kWeed) left.push_back(plant);
  }
  ASSERT_EQ(left.size(), weeds.plants.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_EQ(left[i].p_F_m, weeds.plants[i].p_F_m);
    EXPECT_EQ(left[i].species, weeds.plants[i].species);
  }
}

TEST(GeneratorErrors, Parameters) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const FieldParameters& bad : {
           FieldParameters{.length_m = 0.0},
           FieldParameters{.length_m = nan},
           FieldParameters{.weeds_per_m2 = -1.0},
           FieldParameters{.weeds_per_m2 = std::numeric_limits<double>::infinity()},
           FieldParameters{.pattern = "rows"},
           FieldParameters{.weed_species = {"thistle"}, .weed_shares = {1.0, 2.0}},
           FieldParameters{.weed_species = {"thistle"}, .weed_shares = {0.0}},
           FieldParameters{.weed_leaves_min = 6, .weed_leaves_max = 4},
           FieldParameters{.missing_probability = 1.5},
           FieldParameters{.length_m = 10'000.0, .width_m = 1'000.0},
           FieldParameters{.pattern = "clusters",
           .cluster_weeds = 0.1,
           .cluster_sd_m = 10.0,
           .weed_to_weed_min_m = nan},
       }) {
    const Error error = error_of(bad);
    EXPECT_EQ(error.code, ErrorCode::kOutOfRange) << error.message;
    EXPECT_FALSE(error.message.empty());
  }
  const Error wide = error_of({.width_m = 0.05,
                               .weeds_per_m2 = 10'000.0,
                               .pattern = "clusters",
                               .cluster_weeds = 0.1,
                               .cluster_sd_m = 10.0});
  EXPECT_NE(wide.message.find("too many clusters"), std::string::npos) << wide.message;
}

TEST(GeneratorErrors, Species) {
  EXPECT_EQ(error_of({.weed_species = {"triffid"}}).code, ErrorCode::kNotFound);
  EXPECT_EQ(error_of({.weed_species = {"sugar_beet"}}).code, ErrorCode::kNotFound);
  EXPECT_EQ(error_of({.crop_species = "thistle"}).code, ErrorCode::kNotFound);
  EXPECT_EQ(error_of({.crop = false}, SpeciesTable({})).code, ErrorCode::kNotFound);
  EXPECT_EQ(error_of({.weeds_per_m2 = 0.0, .crop = false}, SpeciesTable({})).message, "");
}

TEST(GeneratorErrors, NoRoom) {
  const Error error = error_of({.weeds_per_m2 = 100.0, .weed_to_weed_min_m = 0.3});
  EXPECT_EQ(error.code, ErrorCode::kNoSolution);
  EXPECT_NE(error.message.find("weed_to_weed_min_m"), std::string::npos);
}

TEST(Presets, HoldTheDensitiesOfThePaper) {
  const std::pair<const char*, double> presets[] = {{"cn20_like", 3.1},
                                                    {"sb20_s1_like", 8.2},
                                                    {"sb20_s2_like", 15.4},
                                                    {"sb21_s1_like", 22.3},
                                                    {"sb21_s2_like", 81.2}};
  const auto declared = declared_parameters<FieldParameters>();
  for (const auto& [name, weeds_per_m2] : presets) {
    std::vector<GivenParameter> given;
    const std::string path = std::string(FURROW_PARAMS_DIR) + "/fields/" + name + ".yaml";
    for (const std::string& line : content_lines(path)) {
      given.push_back(given_from_line(line, declared));
    }
    FieldParameters parameters;
    ParameterLoader::load(given, parameters);
    EXPECT_EQ(parameters.name, name);
    EXPECT_DOUBLE_EQ(parameters.weeds_per_m2, weeds_per_m2);
    const FieldStatistics statistics = statistics_of(generate(parameters, 1));
    EXPECT_GT(statistics.crops, 0u);
    EXPECT_NEAR(statistics.weeds_per_m2, weeds_per_m2, 0.3 * weeds_per_m2);
  }
}

}  // namespace
}  // namespace furrow::field
