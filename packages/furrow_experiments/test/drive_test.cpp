#include "furrow_experiments/drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "furrow_core/error.hpp"
#include "furrow_experiments/audit.hpp"
#include "furrow_experiments/planner_choice.hpp"

namespace furrow::experiments {
namespace {

FieldTargets small_field(double weeds_per_m2, std::uint64_t seed, bool crop = false) {
  RowParameters row;
  row.length_m = 4.0;
  row.crop = crop;
  return *make_targets({"test", weeds_per_m2, std::nullopt}, row, seed);
}

planning::PlannerParameters planner_of(const PlannerChoice& choice, const char* view) {
  planning::PlannerParameters parameters;
  parameters.planner = choice.planner;
  parameters.assignment = choice.assignment;
  parameters.view = view;
  return parameters;
}

FieldTargets two_weeds(double dx_m, double dy_m) {
  FieldTargets field;
  field.length_m = 1.0;
  field.weeds = {{.id = 0, .p_F = {0.3, 0.0}}, {.id = 1, .p_F = {0.3 + dx_m, dy_m}}};
  field.high_priority = {false, false};
  return field;
}

TEST(Setup, PaperAxesStandAboutTheOrigin) {
  const auto axes = axis_specs({});
  ASSERT_EQ(axes.size(), 4U);
  EXPECT_NEAR(axes[0].offset_x_m, 0.18, 1e-12);
  EXPECT_NEAR(axes[3].offset_x_m, -0.18, 1e-12);
  EXPECT_NEAR(axes[0].upper_m, 0.695, 1e-12);
  EXPECT_NEAR(start_x_m({}), -1.18, 1e-12);
}

TEST(Targets, AreThoseOfTheSeed) {
  const FieldTargets field = small_field(20.0, 5);
  EXPECT_EQ(field.weeds.size(), small_field(20.0, 5).weeds.size());
  EXPECT_EQ(field.high_priority, small_field(20.0, 5).high_priority);
  EXPECT_NE(field.high_priority, small_field(20.0, 6).high_priority);
  for (std::size_t i = 1; i < field.weeds.size(); ++i) {
    EXPECT_LE(field.weeds[i - 1].p_F.x(), field.weeds[i].p_F.x());
    EXPECT_EQ(field.weeds[i].id, static_cast<planning::TargetId>(i));
  }
}

TEST(Targets, OneWeedInElevenIsOfHighPriority) {
  RowParameters row;
  row.length_m = 100.0;
  const auto field = make_targets({"test", 81.2, std::nullopt}, row, 1);
  const auto high = std::count(field->high_priority.begin(), field->high_priority.end(), true);
  const auto weeds = static_cast<double>(field->weeds.size());
  // Six standard deviations of a binomial count.
  const double sd = std::sqrt(weeds * (1.0 / 11.0) * (10.0 / 11.0));
  EXPECT_NEAR(static_cast<double>(high), weeds / 11.0, 6.0 * sd);
}

TEST(Targets, BadRowsAreErrors) {
  RowParameters row;
  row.length_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(make_targets({"test", 8.2, std::nullopt}, row, 1).ok());
  EXPECT_FALSE(make_targets({"test", -1.0, std::nullopt}, {}, 1).ok());
  EXPECT_FALSE(imported_field_case(field::FieldModel{}).ok());
}

TEST(Drive, EveryPlannerInBothViewsStandsTheAudit) {
  const FieldTargets field = small_field(22.3, 3);
  for (const PlannerChoice& choice : all_planner_choices()) {
    for (const char* view : {"segment", "rolling"}) {
      const auto driven = drive(field, planner_of(choice, view), {});
      ASSERT_TRUE(driven.ok()) << to_string(choice) << ": " << driven.error().message;
      EXPECT_EQ(driven->outcomes.size(), field.weeds.size());
      std::size_t treated = 0;
      for (const Spray& spray : driven->sprays) treated += spray.treated.size();
      EXPECT_GT(treated, field.weeds.size() / 2) << to_string(choice);
    }
  }
}

TEST(Drive, NoWeedsNoSprays) {
  FieldTargets field;
  field.length_m = 2.0;
  const auto driven = drive(field, {}, {});
  ASSERT_TRUE(driven.ok());
  EXPECT_TRUE(driven->outcomes.empty());
  EXPECT_TRUE(driven->sprays.empty());
  for (const double travel : driven->travel_m) EXPECT_EQ(travel, 0.0);
}

TEST(Drive, OneAxisTreatsBothOnlyWithTimeBetween) {
  // S = dx / 0.5 - dy / 5 must exceed ln(0.6 / 0.4) / 20 = 20.27 ms.
  const SetupParameters one{.axes = 1};
  const auto planner = planner_of({"exact", "joint"}, "rolling");
  const double needed_m = 0.5 * (std::log(1.5) / 20.0 + 0.4 / 5.0);
  EXPECT_EQ(drive(two_weeds(needed_m + 1e-4, 0.4), planner, one)->sprays.size(), 2U);
  EXPECT_EQ(drive(two_weeds(needed_m - 1e-4, 0.4), planner, one)->sprays.size(), 1U);
}

TEST(Drive, FootprintsKeepOutOfProtectionZones) {
  auto planner = planner_of({"footprint", "joint"}, "rolling");
  planner.protection_zone_mm = 20.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const FieldTargets field = small_field(81.2, seed, true);
    ASSERT_GT(field.crops.size(), 20U);
    const auto driven = drive(field, planner, {});
    ASSERT_TRUE(driven.ok()) << driven.error().message;
    for (const Spray& spray : driven->sprays) {
      for (const auto& crop : field.crops) {
        EXPECT_GE((spray.aim_F - crop.p_F).norm(), 0.045 - 1e-6);
      }
    }
  }
}

TEST(Drive, BadParametersThrow) {
  auto planner = planner_of({"footprint", "static"}, "rolling");
  EXPECT_THROW((void)drive(small_field(8.2, 1), planner, {}), ConfigError);
}

class Audit : public testing::Test {
 protected:
  FieldTargets field_ = two_weeds(0.2, 0.3);
  planning::PlannerParameters planner_;
  [[nodiscard]] Status check(const std::vector<Spray>& sprays) const {
    return check_sprays(field_, sprays, planner_, {});
  }
};

TEST_F(Audit, AcceptsWhatIsSound) {
  EXPECT_TRUE(check({{0, {0.3, 0.0}, {0}}, {0, {0.5, 0.3}, {1}}}).ok());
  EXPECT_TRUE(check({}).ok());
}

TEST_F(Audit, RefusesASprayBesideItsWeed) {
  EXPECT_FALSE(check({{0, {0.3, 0.03}, {0}}}).ok());
}

TEST_F(Audit, RefusesAWeedTreatedTwice) {
  EXPECT_FALSE(check({{0, {0.3, 0.0}, {0}}, {1, {0.3, 0.0}, {0}}}).ok());
}

TEST_F(Audit, RefusesSpraysTooSoon) {
  field_ = two_weeds(0.02, 0.3);
  EXPECT_FALSE(check({{0, {0.3, 0.0}, {0}}, {0, {0.32, 0.3}, {1}}}).ok());
  EXPECT_TRUE(check({{0, {0.3, 0.0}, {0}}, {1, {0.32, 0.3}, {1}}}).ok());
}

TEST_F(Audit, RefusesWhatTheAxisCannotReach) {
  field_.weeds[0].p_F.y() = 0.71;
  EXPECT_FALSE(check({{0, {0.3, 0.71}, {0}}}).ok());
  EXPECT_FALSE(check({{7, {0.5, 0.3}, {1}}}).ok());
  EXPECT_FALSE(check({{0, {0.5, 0.3}, {9}}}).ok());
}

TEST_F(Audit, RefusesASprayOnACrop) {
  planner_.protection_zone_mm = 10.0;
  field_.crops = {{.id = 0, .p_F = {0.3, 0.034}}};
  EXPECT_FALSE(check({{0, {0.3, 0.0}, {0}}}).ok());
  field_.crops = {{.id = 0, .p_F = {0.3, 0.036}}};
  EXPECT_TRUE(check({{0, {0.3, 0.0}, {0}}}).ok());
}

}  // namespace
}  // namespace furrow::experiments
