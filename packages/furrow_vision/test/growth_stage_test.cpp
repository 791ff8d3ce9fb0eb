#include "furrow_vision/growth_stage.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "furrow_core/error.hpp"

namespace furrow::vision {
namespace {

TEST(GrowthStage, ChangesAtTheAreasGiven) {
  const GrowthStageEstimator estimator({.two_leaves_mm2 = 100.0,
                                        .four_leaves_mm2 = 200.0,
                                        .six_leaves_mm2 = 300.0,
                                        .eight_leaves_mm2 = 400.0});
  EXPECT_EQ(estimator.stage(99.9), GrowthStage::kCotyledon);
  EXPECT_EQ(estimator.stage(100.0), GrowthStage::kTwoLeaves);
  EXPECT_EQ(estimator.stage(299.0), GrowthStage::kFourLeaves);
  EXPECT_EQ(estimator.stage(300.0), GrowthStage::kSixLeaves);
  EXPECT_EQ(estimator.stage(1e9), GrowthStage::kEightLeaves);
  EXPECT_EQ(leaf_count(GrowthStage::kSixLeaves), 6);
  EXPECT_EQ(to_string(GrowthStage::kEightLeaves), "eight_leaves");
}

TEST(GrowthStage, TakesAnAreaThatIsNoneForACotyledon) {
  const GrowthStageEstimator estimator({});
  EXPECT_EQ(estimator.stage(std::numeric_limits<double>::quiet_NaN()), GrowthStage::kCotyledon);
  EXPECT_EQ(estimator.stage(-5.0), GrowthStage::kCotyledon);
}

TEST(GrowthStage, RefusesAreasOutOfOrder) {
  EXPECT_THROW(GrowthStageEstimator({.two_leaves_mm2 = 600.0}), ConfigError);
  EXPECT_THROW(GrowthStageEstimator({.two_leaves_mm2 = -1.0}), ConfigError);
}

}  // namespace
}  // namespace furrow::vision
