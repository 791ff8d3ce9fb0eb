#include "furrow_vision/vegetation_fusion.hpp"

#include <gtest/gtest.h>

namespace furrow::vision {
namespace {

TEST(FuseVegetation, IndexAndNetworkOverruleEachOther) {
  Vegetation vegetation;
  vegetation.threshold = 100;
  vegetation.soil_end = 100;
  vegetation.otsu = 100;
  vegetation.found = true;
  vegetation.index = (cv::Mat_<std::uint8_t>(1, 4) << 90, 90, 120, 200);
  vegetation.mask = vegetation.index > 100;
  VegetationFusionParameters p;
  p.index_scale = 10.0;
  p.network_logit_max = 3.0;
  p.agreement_exponent = 0.0;
  p.index.median_px = 1;
  // Evidence of the index: -1.05, -1.05, 1.95, cut to 6.
  const cv::Mat logit = (cv::Mat_<float>(1, 4) << 1.0f, 1.1f, -2.0f, -50.0f);
  const auto mask_of = [&](const char* source) {
    p.source = source;
    return cv::Mat(fuse_vegetation(logit, vegetation, p) / 255);
  };
  const auto same = [](const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b) == 0.0; };
  EXPECT_TRUE(same(mask_of("both"), (cv::Mat_<std::uint8_t>(1, 4) << 0, 1, 0, 1)));
  EXPECT_TRUE(same(mask_of("network"), (cv::Mat_<std::uint8_t>(1, 4) << 1, 1, 0, 0)));
  EXPECT_TRUE(same(mask_of("index"), (cv::Mat_<std::uint8_t>(1, 4) << 0, 0, 1, 1)));
  vegetation.found = false;
  EXPECT_TRUE(same(mask_of("both"), (cv::Mat_<std::uint8_t>(1, 4) << 1, 1, 0, 0)));
}

TEST(FuseVegetation, ANetworkThatMissesWhatIsSureIsHeldBack) {
  Vegetation vegetation;
  vegetation.threshold = 100;
  vegetation.soil_end = 100;
  vegetation.otsu = 100;
  vegetation.found = true;
  vegetation.index = (cv::Mat_<std::uint8_t>(1, 5) << 105, 150, 150, 150, 150);
  vegetation.mask = vegetation.index > 100;
  VegetationFusionParameters p;
  p.index_scale = 5.0;  // sure from 120 on
  p.index.median_px = 1;
  const auto first_is_plant = [&](int seen) {
    cv::Mat logit(1, 5, CV_32F, cv::Scalar(-4.0));
    logit.colRange(1, 1 + seen) = 4.0;
    return fuse_vegetation(logit, vegetation, p).at<std::uint8_t>(0, 0) != 0;
  };
  // The index gives 4.5 / 5 = 0.9; the network takes 4 times the share that it sees to the power.
  p.agreement_exponent = 4.0;
  EXPECT_FALSE(first_is_plant(4));  // 0.9 - 4
  EXPECT_FALSE(first_is_plant(3));  // 0.9 - 4 * 0.316
  EXPECT_TRUE(first_is_plant(2));   // 0.9 - 4 * 0.0625
  p.agreement_exponent = 0.0;
  EXPECT_FALSE(first_is_plant(2));
}

TEST(FuseVegetation, ATrustedNetworkRaisesTheThresholdOfTheIndex) {
  Vegetation vegetation;
  vegetation.otsu = kIndexZero + 50;
  vegetation.threshold = kIndexZero + 40;
  vegetation.found = true;
  vegetation.index = (cv::Mat_<std::uint8_t>(1, 3) << kIndexZero + 44, 250, 250);
  vegetation.mask = vegetation.index > vegetation.threshold;
  VegetationFusionParameters p;
  p.index_scale = 1.0;
  p.network_weight = 0.0;  // the trust alone
  p.agreement_exponent = 1.0;
  p.index.threshold_factor = 0.8;
  p.trusted_threshold_factor = 0.9;  // 45 levels above zero, with all of the trust
  p.index.median_px = 1;
  const auto first_is_plant = [&](float second, float third) {
    const cv::Mat logit = (cv::Mat_<float>(1, 3) << 1.0f, second, third);
    return fuse_vegetation(logit, vegetation, p).at<std::uint8_t>(0, 0) != 0;
  };
  EXPECT_FALSE(first_is_plant(1.0f, 1.0f));  // 44 - 45.5
  EXPECT_TRUE(first_is_plant(1.0f, -1.0f));  // 44 - 43.5 at half of it
  vegetation.soil_end = kIndexZero + 44;
  EXPECT_FALSE(first_is_plant(1.0f, -1.0f));
  vegetation.soil_end = 0;
  p.trusted_threshold_factor = 0.8;
  EXPECT_TRUE(first_is_plant(1.0f, 1.0f));
}

}  // namespace
}  // namespace furrow::vision
