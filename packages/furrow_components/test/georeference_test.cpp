#include "furrow_components/georeference.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "furrow_core/error.hpp"
#include "furrow_localization/pose_filter.hpp"

namespace furrow::components {
namespace {

using localization::FixQuality;
using localization::GnssPosition;

GnssPosition position(FixQuality quality, double sigma_x_m, double sigma_y_m) {
  GnssPosition position{.stamp = Time::from_seconds(2.5), .p_FA_m = {12.25, -3.5}};
  position.quality = quality;
  position.covariance = Eigen::Vector2d(sigma_x_m * sigma_x_m, sigma_y_m * sigma_y_m).asDiagonal();
  return position;
}

TEST(Georeference, ConvertsAPositionThereAndBack) {
  GeoreferenceParameters parameters;
  parameters.row_angle_deg = 35.0;
  const Georeference georeference(parameters);
  const GnssPosition there = position(FixQuality::kRtkFixed, 0.008, 0.02);
  const GnssPosition back = georeference.from_msg(georeference.to_msg(there));
  EXPECT_EQ(back.stamp, there.stamp);
  EXPECT_EQ(back.quality, FixQuality::kRtkFixed);
  // Latitude and longitude in degrees keep about 1e-8 m.
  EXPECT_NEAR((back.p_FA_m - there.p_FA_m).norm(), 0.0, 1e-6);
  ASSERT_TRUE(back.covariance.has_value());
  EXPECT_TRUE(back.covariance->isApprox(*there.covariance, 1e-9));
}

TEST(Georeference, RotatesTheCovarianceToEastAndNorth) {
  GeoreferenceParameters parameters;
  parameters.row_angle_deg = 90.0;  // the field's x points north
  const auto fix = Georeference(parameters).to_msg(position(FixQuality::kRtkFixed, 0.01, 0.03));
  EXPECT_NEAR(fix.position_covariance()[0], 0.03 * 0.03, 1e-12);
  EXPECT_NEAR(fix.position_covariance()[4], 0.01 * 0.01, 1e-12);
  EXPECT_GT(fix.latitude(), parameters.origin_latitude_deg);
}

TEST(Georeference, KeepsTheQuality) {
  const Georeference georeference({});
  for (const auto& [quality, sigma_m] : {std::pair{FixQuality::kNone, 1.0},
                                         {FixQuality::kSingle, 1.5},
                                         {FixQuality::kDifferential, 0.5},
                                         {FixQuality::kRtkFloat, 0.15},
                                         {FixQuality::kRtkFixed, 0.01}}) {
    const auto fix = georeference.to_msg(position(quality, sigma_m, sigma_m));
    EXPECT_EQ(georeference.from_msg(fix).quality, quality) << to_string(quality);
  }
}

TEST(Georeference, KeepsAnUnknownCovarianceUnknown) {
  const Georeference georeference({});
  const auto fix = georeference.to_msg(position(FixQuality::kRtkFixed, 0.0, 0.0));
  EXPECT_FALSE(georeference.from_msg(fix).covariance.has_value());
}

/// A filter that knows that it is at position().
localization::PoseFilter filter_there() {
  localization::PoseFilterParameters parameters;
  parameters.initial_x_m = 12.25;
  parameters.initial_y_m = -3.5;
  return localization::PoseFilter(parameters);
}

/// What a filter makes of a fix, and the reason that the user reads.
std::string refusal_of(const sensor_msgs::msg::NavSatFix& fix) {
  const Georeference georeference({});
  localization::PoseFilter filter = filter_there();
  return georeference.refusal(fix, filter.add(georeference.from_msg(fix)));
}

sensor_msgs::msg::NavSatFix good_fix() {
  return Georeference({}).to_msg(position(FixQuality::kRtkFixed, 0.01, 0.01));
}

TEST(Georeference, SaysWhyAFixIsRefused) {
  auto no_fix = good_fix();
  no_fix.status().status(255);  // -1
  EXPECT_EQ(refusal_of(no_fix), "GNSS: the receiver has no fix (status -1)");
  auto nan = good_fix();
  nan.latitude(NAN);
  EXPECT_EQ(refusal_of(nan), "GNSS: latitude, longitude or altitude is not a number");
  auto zero = good_fix();
  zero.position_covariance({});
  EXPECT_NE(refusal_of(zero).find("covariance is zero"), std::string::npos) << refusal_of(zero);
  auto negative = good_fix();
  negative.position_covariance()[0] = -1.0;
  EXPECT_EQ(refusal_of(negative), "GNSS: the covariance is not positive definite");
  auto far = good_fix();
  far.latitude(far.latitude() + 2.0);  // a degree of latitude is 111 km
  const std::string refusal = Georeference({}).refusal(far, localization::Outcome::kInvalid);
  EXPECT_NE(refusal.find("222 km from the origin"), std::string::npos) << refusal;
}

TEST(Georeference, SaysThatARepeatedFixHasTheSameStamp) {
  const Georeference georeference({});
  localization::PoseFilter filter = filter_there();
  const auto fix = good_fix();
  EXPECT_EQ(filter.add(georeference.from_msg(fix)), localization::Outcome::kUsed);
  EXPECT_EQ(georeference.refusal(fix, filter.add(georeference.from_msg(fix))),
            "GNSS: two fixes have the same stamp");
}

TEST(Georeference, RejectsAnOriginThatIsNotOnTheEarth) {
  GeoreferenceParameters parameters;
  parameters.origin_latitude_deg = NAN;
  EXPECT_THROW((void)Georeference(parameters), ConfigError);
}

}  // namespace
}  // namespace furrow::components
