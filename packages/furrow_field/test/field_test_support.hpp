#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "furrow_core/random.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// A valid field of plants with arbitrary figures, some with awkward texts.
inline FieldModel random_field(std::uint64_t seed, int plants) {
  Random random(seed, "test_field");
  FieldModel field;
  field.name = "field " + std::to_string(seed);
  field.source = "made, by \"a\" test: #1";
  field.length_m = random.uniform(1.0, 30.0);
  field.width_m = random.uniform(0.5, 3.0);
  field.row_y_m = {-0.1, random.uniform(0.0, 0.2)};
  const char* species[] = {"sugar_beet", "", "a, b", "say \"x\"", "#odd", "größer"};
  for (int i = 0; i < plants; ++i) {
    Plant plant;
    plant.id = 7 * i - 3;
    plant.kind = random.bernoulli(0.5) ? PlantKind::kCrop : PlantKind::kWeed;
    plant.species = species[random.integer(0, 5)];
    plant.p_F_m = {random.uniform(0.0, field.length_m),
                   random.uniform(-0.5 * field.width_m, 0.5 * field.width_m)};
    plant.radius_m = random.exponential(0.03);
    plant.area_mm2 = random.exponential(500.0);
    plant.leaves = static_cast<int>(random.integer(0, 12));
    plant.heading_rad = random.normal(0.0, 2.0);
    field.plants.push_back(plant);
  }
  sort_plants(field);
  return field;
}

inline void expect_equal(const FieldModel& a, const FieldModel& b, double tolerance_m = 0.0) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.length_m, b.length_m);
  EXPECT_EQ(a.width_m, b.width_m);
  EXPECT_EQ(a.row_y_m, b.row_y_m);
  ASSERT_EQ(a.plants.size(), b.plants.size());
  for (std::size_t i = 0; i < a.plants.size(); ++i) {
    const Plant& p = a.plants[i];
    const Plant& q = b.plants[i];
    EXPECT_EQ(p.id, q.id);
    EXPECT_EQ(p.kind, q.kind);
    EXPECT_EQ(p.species, q.species);
    EXPECT_LE((p.p_F_m - q.p_F_m).norm(), tolerance_m);
    EXPECT_EQ(p.radius_m, q.radius_m);
    EXPECT_EQ(p.area_mm2, q.area_mm2);
    EXPECT_EQ(p.leaves, q.leaves);
    EXPECT_EQ(p.heading_rad, q.heading_rad);
  }
}

}  // namespace furrow::field
