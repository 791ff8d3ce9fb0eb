#include "furrow_vision/row_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace furrow::vision {
namespace {

constexpr double kLikelyCrop = 3.0, kLikelyWeed = -3.0;

/// Five likely crops 150 mm apart along `direction_rad`, then `others`.
std::vector<RowPlant> row_with(const std::vector<RowPlant>& others, double direction_rad) {
  const Eigen::Vector2d along(std::cos(direction_rad), std::sin(direction_rad));
  std::vector<RowPlant> plants;
  for (int k = 0; k < 5; ++k) plants.push_back({150.0 * k * along, 2000.0, kLikelyCrop});
  plants.insert(plants.end(), others.begin(), others.end());
  return plants;
}

TEST(RowEvidence, SpeaksForCropsOnTheRowAndAgainstThemBeside) {
  for (const double direction_rad : {0.0, 0.4, std::numbers::pi / 2, 2.5}) {
    const Eigen::Vector2d across(-std::sin(direction_rad), std::cos(direction_rad));
    const auto plants = row_with({{225.0 * across, 2000.0, kLikelyWeed}}, direction_rad);
    const auto evidence = row_evidence(plants, {});
    // 5 plants of probability 1 / (1 + e^-3) against one of 1 / (1 + e^3): the row has .990 of
    // the weight, and (.990 - .3) / .7 = .986 of the evidence counts. Directions are 3 degrees
    // apart, so that the ends of the row lie up to 8 mm beside the line found.
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(evidence[i], 0.986, 0.05);
    EXPECT_NEAR(evidence[5], -0.986, 0.02);
  }
}

TEST(RowEvidence, HelpsAnUncertainPlantThatStandsInTheRow) {
  const auto evidence = row_evidence(
      row_with({{{75.0, 0.0}, 900.0, kLikelyWeed}, {{75.0, 300.0}, 900.0, kLikelyCrop}}, 0.0), {});
  EXPECT_GT(evidence[5], 0.5);
  EXPECT_LT(evidence[6], -0.5);
}

TEST(RowEvidence, SaysNothingWithoutARow) {
  EXPECT_TRUE(row_evidence({}, {}).empty());
  const std::vector<RowPlant> two = {{{0.0, 0.0}, 2000.0, 3.0}, {{0.0, 150.0}, 2000.0, 3.0}};
  EXPECT_EQ(row_evidence(two, {}), std::vector<double>(2, 0.0));

  std::vector<RowPlant> small = row_with({}, 0.0);
  for (RowPlant& plant : small) plant.area_mm2 = 150.0;
  EXPECT_EQ(row_evidence(small, {}), std::vector<double>(5, 0.0));

  // Nine equal plants on a circle of 2 m: no line near to more than two of them.
  std::vector<RowPlant> circle;
  for (int k = 0; k < 9; ++k) {
    const double angle_rad = 2.0 * std::numbers::pi * k / 9;
    circle.push_back({{2000.0 * std::cos(angle_rad), 2000.0 * std::sin(angle_rad)}, 2000.0, 3.0});
  }
  EXPECT_EQ(row_evidence(circle, {}), std::vector<double>(9, 0.0));
}

TEST(RowEvidence, IsBoundedInPlantsThatVote) {
  std::vector<RowPlant> plants = row_with({}, 0.0);
  for (std::size_t k = 0; k < 2 * kMaxRowPlants; ++k) {
    plants.push_back({{1.0 * static_cast<double>(k), 400.0}, 300.0, -20.0});
  }
  const auto evidence = row_evidence(plants, {});
  ASSERT_EQ(evidence.size(), plants.size());
  EXPECT_GT(evidence[0], 0.9);
  EXPECT_LT(evidence.back(), -0.9);
}

}  // namespace
}  // namespace furrow::vision
