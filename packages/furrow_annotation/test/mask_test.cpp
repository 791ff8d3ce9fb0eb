#include "furrow_annotation/mask.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace furrow::annotation {
namespace {

TEST(Mask, IsCutToTheBoxOfWhatIsSet) {
  cv::Mat full = cv::Mat::zeros(10, 20, CV_8U);
  full(cv::Rect(4, 2, 3, 5)).setTo(255);
  AnnotatedInstance instance;
  ASSERT_TRUE(cut_to_box(full, instance));
  EXPECT_EQ(instance.box_px, cv::Rect(4, 2, 3, 5));
  EXPECT_EQ(cv::countNonZero(instance.mask), 15);
  EXPECT_FALSE(cut_to_box(cv::Mat::zeros(10, 20, CV_8U), instance));
  EXPECT_EQ(instance.box_px, cv::Rect(4, 2, 3, 5));
}

TEST(Mask, IsMeasuredByPixelCentres) {
  AnnotatedInstance instance;
  instance.box_px = {4, 2, 3, 2};
  instance.mask = (cv::Mat_<std::uint8_t>(2, 3) << 255, 255, 255, 255, 0, 0);
  const MaskMeasures measures = measure(instance);
  EXPECT_DOUBLE_EQ(measures.area_px2, 4.0);
  EXPECT_DOUBLE_EQ(measures.centroid_px.x(), (4 + 5 + 6 + 4) / 4.0);
  EXPECT_DOUBLE_EQ(measures.centroid_px.y(), (2 + 2 + 2 + 3) / 4.0);
  EXPECT_DOUBLE_EQ(reach_px(instance, {4.0, 3.0}), std::hypot(2.0, 1.0));
}

}  // namespace
}  // namespace furrow::annotation
