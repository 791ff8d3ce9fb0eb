#include "furrow_actuation/as_applied.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

namespace furrow::actuation {
namespace {

Application at(double x, double y, double radius_m = 0.025) {
  Application a;
  a.axis = "axis \"1\"";
  a.time = Time::from_seconds(12.5);
  a.open_s = 0.01;
  a.volume_ml = 0.05;
  a.p_F = {x, y};
  a.radius_m = radius_m;
  a.track_ids = {7, 8};
  return a;
}

double disc_m2(double radius_m) {
  return std::numbers::pi * radius_m * radius_m;
}

TEST(SprayedArea, IsTheUnionOfTheFootprints) {
  const double one = disc_m2(0.025);
  EXPECT_EQ(sprayed_area_m2({}), 0.0);
  EXPECT_NEAR(sprayed_area_m2(std::vector{at(0.1, 0.2)}), one, 0.02 * one);
  EXPECT_NEAR(sprayed_area_m2(std::vector{at(0.1, 0.2), at(3.0, 0.2)}), 2 * one, 0.04 * one);
  EXPECT_NEAR(sprayed_area_m2(std::vector{at(0.1, 0.2), at(0.1, 0.2)}), one, 0.02 * one);
  // Two circles of radius r at distance r share r^2 (2 pi / 3 - sqrt(3) / 2).
  const double lens = 0.025 * 0.025 * (2.0 * std::numbers::pi / 3.0 - std::sqrt(3.0) / 2.0);
  EXPECT_NEAR(sprayed_area_m2(std::vector{at(0.1, 0.2), at(0.125, 0.2)}), 2 * one - lens,
              0.04 * one);
  // A small one inside a large one, in whatever order.
  EXPECT_NEAR(sprayed_area_m2(std::vector{at(1.0, 0.0, 0.2), at(0.9, 0.0)}), disc_m2(0.2), 0.001);
}

TEST(SprayedArea, LeavesOutWhatIsNoFootprint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sprayed_area_m2(std::vector{at(nan, 0.0), at(0.0, 0.0, 0.0), at(0.0, 0.0, -1.0),
                                        at(0.0, 0.0, nan), at(0.0, 0.0, 1e9)}),
            0.0);
}

TEST(AsApplied, IsAFeatureCollectionInLongitudeAndLatitude) {
  const std::vector sprays = {at(1.0, 2.0), at(std::numeric_limits<double>::infinity(), 0.0)};
  const auto json = nlohmann::json::parse(as_applied_geojson(sprays, [](const auto& p_F) {
    return Eigen::Vector2d(7.0 + 1e-5 * p_F.x(), 50.0 + 1e-5 * p_F.y());
  }));
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), 1u);  // the other one is nowhere on the earth
  const auto& feature = json["features"][0];
  EXPECT_EQ(feature["geometry"]["type"], "Point");
  EXPECT_NEAR(feature["geometry"]["coordinates"][0], 7.00001, 1e-9);
  EXPECT_NEAR(feature["geometry"]["coordinates"][1], 50.00002, 1e-9);
  EXPECT_EQ(feature["properties"]["axis"], "axis \"1\"");
  EXPECT_NEAR(feature["properties"]["volume_ml"], 0.05, 1e-9);
  EXPECT_EQ(feature["properties"]["track_ids"], nlohmann::json({7, 8}));
}

}  // namespace
}  // namespace furrow::actuation
