#include "furrow_simulation/plant_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "scene_fixture.hpp"

namespace furrow::simulation {
namespace {

using field::LeafForm;

constexpr LeafForm kForms[] = {LeafForm::kBeet,    LeafForm::kBroadleaf, LeafForm::kLobed,
                               LeafForm::kGrass,   LeafForm::kFeathery,  LeafForm::kTrifoliate,
                               LeafForm::kRosette, LeafForm::kThistle,   LeafForm::kWhorled};

TEST(PlantMesh, EveryFormAndStageIsSoundAndBounded) {
  for (const LeafForm form : kForms) {
    for (int leaves = 2; leaves <= 8; ++leaves) {
      const auto p = plant(leaves, "x", 0, 0, 0.05, 3000, leaves);
      const PlantMesh mesh = build_plant_mesh(p, form, {}, 9);
      ASSERT_GT(mesh.triangles.size(), 8u);
      EXPECT_LE(mesh.radius_m, max_mesh_radius_m(p) + 1e-6);
      EXPECT_GE(mesh.radius_m, 0.05 / 1.25 - 1e-6);
      EXPECT_LE(mesh.height_m, 1.1 * max_mesh_radius_m(p) + 1e-6);
      EXPECT_GT(mesh.top_area_mm2, 0.0);
      EXPECT_LE(mesh.top_area_mm2, 1e6 * std::numbers::pi * mesh.radius_m * mesh.radius_m);
      for (const auto& v : mesh.vertices) {
        ASSERT_TRUE(v.p_P.allFinite());
        ASSERT_NEAR(v.normal_P.norm(), 1.0f, 1e-4f);
        ASSERT_GE(v.normal_P.z(), 0.0f);
      }
      for (const auto& t : mesh.triangles) {
        for (const auto i : t) ASSERT_LT(i, mesh.vertices.size());
      }
    }
  }
}

// A cover that the form can have gives the area that was asked for.
TEST(PlantMesh, AreaComesNearToThePlants) {
  const struct {
    LeafForm form;
    double cover;
    int leaves;
  } cases[] = {{LeafForm::kBeet, 0.45, 8},     {LeafForm::kLobed, 0.4, 6},
               {LeafForm::kBroadleaf, 0.4, 6}, {LeafForm::kGrass, 0.15, 5},
               {LeafForm::kRosette, 0.4, 8},   {LeafForm::kThistle, 0.35, 6},
               {LeafForm::kFeathery, 0.3, 6},  {LeafForm::kTrifoliate, 0.35, 6},
               {LeafForm::kWhorled, 0.25, 6}};
  for (const auto& c : cases) {
    const double area = 1e6 * c.cover * std::numbers::pi * 0.05 * 0.05;
    for (std::int64_t id = 0; id < 5; ++id) {
      const PlantMesh mesh =
          build_plant_mesh(plant(id, "x", 0, 0, 0.05, area, c.leaves), c.form, {}, 9);
      EXPECT_NEAR(mesh.top_area_mm2, area, 0.2 * area) << static_cast<int>(c.form);
    }
  }
}

TEST(PlantMesh, AreaOfAKnownShape) {
  PlantMesh mesh;
  for (const auto& corner : {Eigen::Vector3f(0, 0, 0.01f), Eigen::Vector3f(0.04f, 0, 0.02f),
                             Eigen::Vector3f(0, 0.03f, 0)}) {
    PlantVertex v;
    v.p_P = corner;
    mesh.vertices.push_back(v);
  }
  EXPECT_EQ(top_view_area_mm2(mesh), 0.0);
  mesh.triangles.push_back({0, 1, 2});
  EXPECT_NEAR(top_view_area_mm2(mesh), 600.0, 12.0);
}

TEST(PlantMesh, MissingOrBrokenSizesAreFilledIn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto p = plant(1, "x", 0, 0, 0.0, 0.0, 4);
  EXPECT_NEAR(build_plant_mesh(p, LeafForm::kLobed, {}, 1).radius_m, 0.010, 1e-6);
  p.area_mm2 = 4000.0;
  EXPECT_NEAR(build_plant_mesh(p, LeafForm::kLobed, {}, 1).top_area_mm2, 4000.0, 1000.0);
  p.radius_m = nan;
  p.area_mm2 = nan;
  p.heading_rad = nan;
  p.leaves = -3;
  EXPECT_NEAR(build_plant_mesh(p, LeafForm::kGrass, {}, 1).radius_m, 0.010, 1e-6);
  p.radius_m = 1e9;
  p.leaves = 1'000'000;
  const PlantMesh huge = build_plant_mesh(p, LeafForm::kFeathery, {}, 1);
  EXPECT_LE(huge.radius_m, 0.5001);
  EXPECT_LT(huge.triangles.size(), 30'000u);
}

TEST(PlantMesh, FollowsTheSpeciesTable) {
  const auto table = field::SpeciesTable::defaults();
  EXPECT_EQ(leaf_form(table, plant(1, "barnyardgrass", 0, 0, 0, 0, 2)), LeafForm::kGrass);
  EXPECT_EQ(leaf_form(table, plant(1, "sugar_beet", 0, 0, 0, 0, 2)), LeafForm::kBeet);
  auto unknown = plant(1, "unheard_of", 0, 0, 0, 0, 2);
  EXPECT_EQ(leaf_form(table, unknown), LeafForm::kBroadleaf);
  unknown.kind = field::PlantKind::kCrop;
  EXPECT_EQ(leaf_form(table, unknown), LeafForm::kBeet);
}

}  // namespace
}  // namespace furrow::simulation
