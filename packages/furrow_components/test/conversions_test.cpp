#include "furrow_components/conversions.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "furrow_components/field_conversion.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_components/pose_buffer.hpp"

namespace furrow::components {
namespace {

TEST(Conversions, OdometryIsTheSameThereAndBack) {
  const BaseOdometry odometry{Time::from_seconds(3.25), {1.0, -2.0, 2.5}, 0.5, -0.1};
  const BaseOdometry copy = from_msg(to_msg(odometry, kFieldFrame));
  EXPECT_EQ(copy.stamp, odometry.stamp);
  EXPECT_DOUBLE_EQ(copy.X_FB.x_m, 1.0);
  EXPECT_DOUBLE_EQ(copy.X_FB.y_m, -2.0);
  EXPECT_NEAR(copy.X_FB.heading_rad, 2.5, 1e-12);
  EXPECT_EQ(copy.speed_mps, 0.5);
  EXPECT_EQ(copy.yaw_rate_radps, -0.1);
}

TEST(Conversions, FieldIsTheSameThereAndBack) {
  field::FieldModel field{.name = "f", .source = "made by hand", .length_m = 3, .width_m = 1};
  field.row_y_m = {0.25};
  field.plants.push_back({.id = 4,
                          .kind = field::PlantKind::kCrop,
                          .species = "sugar_beet",
                          .p_F_m = {1, 0.25},
                          .radius_m = 0.05,
                          .area_mm2 = 4000,
                          .leaves = 6,
                          .heading_rad = 1});
  const field::FieldModel copy = from_msg(to_msg(field, Time()));
  EXPECT_EQ(copy.source, field.source);
  EXPECT_EQ(copy.row_y_m, field.row_y_m);
  ASSERT_EQ(copy.plants.size(), 1u);
  EXPECT_EQ(copy.plants[0].kind, field::PlantKind::kCrop);
  EXPECT_EQ(copy.plants[0].p_F_m, field.plants[0].p_F_m);
  EXPECT_EQ(copy.plants[0].leaves, 6);
}

TEST(Conversions, ImagesAreViewedWithoutACopy) {
  cv::Mat image(3, 5, CV_8UC3, cv::Scalar(1, 2, 3));
  const auto message = to_msg(image(cv::Rect(1, 0, 3, 3)), Time(), "c");
  EXPECT_EQ(message.width(), 3u);
  EXPECT_EQ(message.step(), 9u);
  const auto view = bgr_of(message);
  ASSERT_TRUE(view.ok());
  EXPECT_EQ(view->data, message.data().data());
  EXPECT_EQ(view->at<cv::Vec3b>(2, 2), cv::Vec3b(1, 2, 3));
}

TEST(Conversions, DepthInMillimetresIsConverted) {
  const cv::Mat depth_mm(2, 2, CV_16UC1, cv::Scalar(1250));
  const auto depth_m = depth_m_of(to_msg(depth_mm, Time(), "c"));
  ASSERT_TRUE(depth_m.ok());
  EXPECT_FLOAT_EQ(depth_m->at<float>(1, 1), 1.25F);
}

TEST(Conversions, InvalidImagesAreErrors) {
  auto message = to_msg(cv::Mat(4, 4, CV_8UC3, cv::Scalar(0)), Time(), "c");
  const auto fails = [&] { return !bgr_of(message).ok(); };
  auto good = message;
  message.data().resize(20);
  EXPECT_TRUE(fails());
  message = good;
  message.encoding("h264");
  EXPECT_TRUE(fails());
  message = good;
  message.width(0);
  EXPECT_TRUE(fails());
  message = good;
  message.height(0xFFFFFFFF);
  EXPECT_TRUE(fails());
  EXPECT_FALSE(bgr_of(to_msg(cv::Mat(4, 4, CV_32FC1, cv::Scalar(0)), Time(), "c")).ok());
  EXPECT_FALSE(depth_m_of(good).ok());
}

TEST(Conversions, MasksBecomeRunsAndBack) {
  cv::Mat mask(2, 3, CV_8UC1, cv::Scalar(0));
  mask.at<std::uint8_t>(0, 1) = 255;
  mask.at<std::uint8_t>(0, 2) = 255;
  mask.at<std::uint8_t>(1, 0) = 255;
  const auto runs = mask_runs(mask);
  EXPECT_EQ(runs, (std::vector<std::uint32_t>{1, 3, 2}));
  const auto copy = mask_from_runs(runs, 3, 2);
  ASSERT_TRUE(copy.ok());
  EXPECT_EQ(cv::countNonZero(*copy != mask), 0);
  EXPECT_FALSE(mask_from_runs({1, 3, 3}, 3, 2).ok());
  EXPECT_FALSE(mask_from_runs({1, 3}, 3, 2).ok());
  EXPECT_FALSE(mask_from_runs({7}, 3, 2).ok());
  EXPECT_EQ(mask_runs(cv::Mat(1, 2, CV_8UC1, cv::Scalar(255))), (std::vector<std::uint32_t>{0, 2}));
}

TEST(PoseBuffer, InterpolatesAndExtrapolates) {
  PoseBuffer buffer(Duration::seconds(1.0));
  EXPECT_EQ(buffer.at(Time()).error().code, ErrorCode::kUnavailable);
  ASSERT_TRUE(buffer.add({Time::from_seconds(1.0), {0, 0, 0}, 1.0, 0.0}).ok());
  ASSERT_TRUE(buffer.add({Time::from_seconds(2.0), {1, 0, 0}, 1.0, 0.0}).ok());
  EXPECT_NEAR(buffer.at(Time::from_seconds(1.25))->X_FB.x_m, 0.25, 1e-12);
  EXPECT_NEAR(buffer.at(Time::from_seconds(2.1), Duration::seconds(0.2))->X_FB.x_m, 1.1, 1e-12);
  EXPECT_EQ(buffer.at(Time::from_seconds(2.3), Duration::seconds(0.2)).error().code,
            ErrorCode::kStale);
  EXPECT_EQ(buffer.at(Time::from_seconds(0.5)).error().code, ErrorCode::kStale);
}

TEST(PoseBuffer, ExtrapolatesAlongAnArc) {
  PoseBuffer buffer(Duration::seconds(2.0));
  // A quarter of a circle of radius 1 m in a second.
  const double rate = std::numbers::pi / 2.0;
  ASSERT_TRUE(buffer.add({Time(), {0, 0, 0}, rate, rate}).ok());
  const auto pose = buffer.at(Time::from_seconds(1.0), Duration::seconds(1.0));
  ASSERT_TRUE(pose.ok());
  EXPECT_NEAR(pose->X_FB.x_m, 1.0, 1e-12);
  EXPECT_NEAR(pose->X_FB.y_m, 1.0, 1e-12);
}

TEST(PoseBuffer, RefusesEarlierStampsAndInvalidNumbers) {
  PoseBuffer buffer(Duration::seconds(1.0));
  ASSERT_TRUE(buffer.add({Time::from_seconds(1.0), {}, 0, 0}).ok());
  EXPECT_EQ(buffer.add({Time::from_seconds(1.0), {}, 0, 0}).error().code, ErrorCode::kStale);
  EXPECT_EQ(buffer.add({Time::from_seconds(2.0), {NAN, 0, 0}, 0, 0}).error().code,
            ErrorCode::kInvalidArgument);
}

TEST(PoseBuffer, AcceptsStampsAfterOneFarAhead) {
  PoseBuffer buffer(Duration::seconds(1.0));
  ASSERT_TRUE(buffer.add({Time::from_seconds(1.0), {1, 0, 0}, 0, 0}).ok());
  EXPECT_EQ(buffer.add({Time::from_seconds(1e6), {9, 0, 0}, 0, 0}).error().code, ErrorCode::kStale);
  ASSERT_TRUE(buffer.add({Time::from_seconds(1.5), {2, 0, 0}, 0, 0}).ok());
  EXPECT_NEAR(buffer.at(Time::from_seconds(1.25))->X_FB.x_m, 1.5, 1e-12);
}

TEST(PoseBuffer, ContinuesAfterAGap) {
  PoseBuffer buffer(Duration::seconds(1.0));
  ASSERT_TRUE(buffer.add({Time::from_seconds(1.0), {}, 0, 0}).ok());
  for (int i = 1; i < PoseBuffer::kAgreeing; ++i) {
    EXPECT_FALSE(buffer.add({Time::from_seconds(60.0 + 0.02 * i), {}, 0, 0}).ok());
  }
  // Another wrong stamp restarts the count.
  EXPECT_FALSE(buffer.add({Time::from_seconds(1e6), {}, 0, 0}).ok());
  for (int i = 1; i < PoseBuffer::kAgreeing; ++i) {
    EXPECT_FALSE(buffer.add({Time::from_seconds(61.0 + 0.02 * i), {}, 0, 0}).ok());
  }
  ASSERT_TRUE(buffer.add({Time::from_seconds(61.5), {5, 0, 0}, 0, 0}).ok());
  EXPECT_DOUBLE_EQ(buffer.newest().X_FB.x_m, 5.0);
  EXPECT_FALSE(buffer.at(Time::from_seconds(30.0)).ok());
}

}  // namespace
}  // namespace furrow::components
