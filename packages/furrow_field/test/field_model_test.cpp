#include "furrow_field/field_model.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "field_test_support.hpp"
#include "furrow_field/statistics.hpp"

namespace furrow::field {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class Change>
std::string error_after(const Change& change) {
  FieldModel field = random_field(1, 5);
  change(field);
  const Status status = validate(field);
  return status.ok() ? "" : status.error().message;
}

TEST(Validate, AcceptsWhatItShould) {
  EXPECT_TRUE(validate({}).ok());
  for (int seed = 0; seed < 20; ++seed) EXPECT_TRUE(validate(random_field(seed, 50)).ok());
}

TEST(Validate, NamesWhatIsWrong) {
  const auto contains = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(contains(error_after([](auto& f) { f.length_m = kNan; }), "length_m"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.length_m = 1e9; }), "length_m"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.width_m = -1.0; }), "width_m"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.row_y_m[0] = kNan; }), "row_y_m"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.source = "a\nb"; }), "control"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[2].p_F_m.y() = kNan; }), "not finite"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[4].p_F_m.x() = 31.0; }), "outside"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[1].radius_m = -1.0; }), "radius_m"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[1].area_mm2 = kNan; }), "area_mm2"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[1].leaves = -1; }), "leaves"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[1].species = "\t"; }), "species"));
  EXPECT_TRUE(contains(error_after([](auto& f) { f.plants[1].id = f.plants[3].id; }), "unique"));
  EXPECT_TRUE(contains(error_after([](auto& f) { std::swap(f.plants[0], f.plants[1]); }), "order"));
}

TEST(SortPlants, OrdersByXThenId) {
  FieldModel field;
  field.length_m = 2.0;
  for (const auto& [id, x_m] : {std::pair(5, 1.0), std::pair(2, 1.0), std::pair(9, 0.5)}) {
    Plant plant;
    plant.id = id;
    plant.p_F_m.x() = x_m;
    field.plants.push_back(plant);
  }
  sort_plants(field);
  EXPECT_EQ(field.plants[0].id, 9);
  EXPECT_EQ(field.plants[1].id, 2);
  EXPECT_EQ(field.plants[2].id, 5);
  EXPECT_TRUE(validate(field).ok());
}

TEST(PlantKind, NamesReadBack) {
  EXPECT_EQ(plant_kind_from(to_string(PlantKind::kCrop)), PlantKind::kCrop);
  EXPECT_EQ(plant_kind_from(to_string(PlantKind::kWeed)), PlantKind::kWeed);
  EXPECT_FALSE(plant_kind_from("Crop").has_value());
}

TEST(Statistics, CountsByHand) {
  FieldModel field;
  field.length_m = 10.0;
  field.width_m = 2.0;
  const auto add = [&](PlantKind kind, const char* species, double area_mm2) {
    Plant plant;
    plant.kind = kind;
    plant.species = species;
    plant.area_mm2 = area_mm2;
    field.plants.push_back(plant);
  };
  add(PlantKind::kCrop, "sugar_beet", 1e6);
  add(PlantKind::kWeed, "violet", 1e5);
  add(PlantKind::kWeed, "thistle", 1e5);
  add(PlantKind::kWeed, "thistle", 2e5);
  const FieldStatistics statistics = statistics_of(field);
  EXPECT_DOUBLE_EQ(statistics.area_m2, 20.0);
  EXPECT_EQ(statistics.crops, 1u);
  EXPECT_EQ(statistics.weeds, 3u);
  EXPECT_DOUBLE_EQ(statistics.crops_per_m2, 0.05);
  EXPECT_DOUBLE_EQ(statistics.weeds_per_m2, 0.15);
  EXPECT_DOUBLE_EQ(statistics.crop_cover, 0.05);
  EXPECT_DOUBLE_EQ(statistics.weed_cover, 0.02);
  ASSERT_EQ(statistics.by_species.size(), 3u);
  EXPECT_EQ(statistics.by_species[0].species, "thistle");
  EXPECT_EQ(statistics.by_species[0].plants, 2u);
  EXPECT_EQ(statistics.by_species[1].species, "sugar_beet");
  EXPECT_EQ(statistics.by_species[2].species, "violet");
}

TEST(Statistics, AFieldWithoutAreaHasNoRates) {
  const FieldStatistics statistics = statistics_of({});
  EXPECT_EQ(statistics.weeds_per_m2, 0.0);
  EXPECT_EQ(statistics.crop_cover, 0.0);
  EXPECT_TRUE(statistics.by_species.empty());
}

}  // namespace
}  // namespace furrow::field
