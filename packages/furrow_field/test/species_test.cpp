#include "furrow_field/species.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "furrow_core/error.hpp"
#include "plain_yaml.hpp"

namespace furrow::field {
namespace {

void expect_equal(const Species& a, const Species& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.botanical, b.botanical);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.growth_form, b.growth_form);
  EXPECT_EQ(a.leaf_form, b.leaf_form);
  EXPECT_EQ(a.beta, b.beta);
  EXPECT_EQ(a.priority, b.priority);
  EXPECT_EQ(a.beneficial, b.beneficial);
  EXPECT_EQ(a.radius_two_leaves_m, b.radius_two_leaves_m);
  EXPECT_EQ(a.radius_eight_leaves_m, b.radius_eight_leaves_m);
  EXPECT_EQ(a.leaf_cover, b.leaf_cover);
}

TEST(SpeciesTable, DefaultsAreOneCropAndTwelveWeedsOfBothForms) {
  const SpeciesTable table = SpeciesTable::defaults();
  EXPECT_EQ(table.names(PlantKind::kCrop), std::vector<std::string>{"sugar_beet"});
  EXPECT_EQ(table.names(PlantKind::kWeed).size(), 12u);
  int grasses = 0;
  for (const Species& species : table.all()) {
    grasses += species.growth_form == GrowthForm::kGrass ? 1 : 0;
    if (species.beneficial) {
      EXPECT_EQ(species.growth_form, GrowthForm::kBroadleaf) << species.name;
      EXPECT_LT(species.priority, 1.0) << species.name;
    }
  }
  EXPECT_EQ(grasses, 2);
  ASSERT_NE(table.find("thistle"), nullptr);
  EXPECT_EQ(table.find("thistle")->botanical, "Cirsium arvense");
  EXPECT_EQ(table.find("Thistle"), nullptr);
}

TEST(SpeciesTable, TheShippedFileHoldsTheDefaults) {
  const auto declared = declared_parameters<Species>();
  std::vector<std::vector<GivenParameter>> entries;
  for (std::string line : content_lines(std::string(FURROW_PARAMS_DIR) + "/species.yaml")) {
    if (line == "species:") continue;
    ASSERT_GT(line.size(), 4u);
    if (line.substr(0, 4) == "  - ") entries.emplace_back();
    ASSERT_FALSE(entries.empty());
    entries.back().push_back(given_from_line(line.substr(4), declared));
  }
  const SpeciesTable table = SpeciesTable::defaults();
  ASSERT_EQ(entries.size(), table.all().size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].size(), declared.size());
    Species species;
    ParameterLoader::load(entries[i], species);
    expect_equal(species, table.all()[i]);
  }
}

TEST(SpeciesTable, LoadingChoosesEnumsByName) {
  Species species;
  ParameterLoader::load({{"kind", std::string("crop"), {}},
                         {"growth_form", std::string("grass"), {}},
                         {"leaf_form", std::string("whorled"), {}}},
                        species);
  EXPECT_EQ(species.kind, PlantKind::kCrop);
  EXPECT_EQ(species.growth_form, GrowthForm::kGrass);
  EXPECT_EQ(species.leaf_form, LeafForm::kWhorled);
  EXPECT_THROW(ParameterLoader::load({{"leaf_form", std::string("round"), {}}}, species),
               ConfigError);
}

TEST(SpeciesTable, RefusesBadEntries) {
  const Species good{.name = "a"};
  EXPECT_NO_THROW(SpeciesTable({good}));
  const auto error_of = [](std::vector<Species> species) -> std::string {
    try {
      SpeciesTable table(std::move(species));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(error_of({good, good}).find("'a': the name is there twice"), std::string::npos);
  for (const char* name : {"", "Beta vulgaris", "a\nb", "ä"}) {
    EXPECT_NE(error_of({{.name = name}}).find("lower case"), std::string::npos) << name;
  }
  EXPECT_NE(error_of({{.name = "a", .beta = -1.0}}).find("beta"), std::string::npos);
  EXPECT_NE(error_of({{.name = "a", .beta = std::nan("")}}).find("beta"), std::string::npos);
  EXPECT_NE(error_of({{.name = "a", .priority = 1.1}}).find("priority"), std::string::npos);
  EXPECT_NE(error_of({{.name = "a", .leaf_cover = 0.0}}).find("leaf_cover"), std::string::npos);
}

TEST(GrowthStage, RadiusGrowsGeometricallyBetweenTwoAndEightLeaves) {
  const Species species{.name = "a", .radius_two_leaves_m = 0.01, .radius_eight_leaves_m = 0.04};
  EXPECT_DOUBLE_EQ(canopy_radius_m(species, 2), 0.01);
  EXPECT_DOUBLE_EQ(canopy_radius_m(species, 5), 0.02);
  EXPECT_DOUBLE_EQ(canopy_radius_m(species, 8), 0.04);
  EXPECT_DOUBLE_EQ(canopy_radius_m(species, 0), 0.01);
  EXPECT_DOUBLE_EQ(canopy_radius_m(species, 20), 0.04);
}

TEST(GrowthStage, LeafAreaIsTheCoveredShareOfTheDisc) {
  const Species species{.name = "a", .leaf_cover = 0.25};
  EXPECT_NEAR(leaf_area_mm2(species, 0.02), 0.25 * std::numbers::pi * 400.0, 1e-9);
}

}  // namespace
}  // namespace furrow::field
