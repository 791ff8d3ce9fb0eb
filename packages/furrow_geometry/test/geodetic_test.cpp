#include "furrow_geometry/geodetic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "furrow_core/random.hpp"

namespace furrow::geometry {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

// WGS 84 from its defining constants, independent of the library.
constexpr double kA = 6378137.0;
constexpr double kE2 = (2.0 - 1.0 / 298.257223563) / 298.257223563;

double meridian_radius_m(double latitude_deg) {
  const double s = std::sin(latitude_deg * kDegree);
  return kA * (1.0 - kE2) / std::pow(1.0 - kE2 * s * s, 1.5);
}
double prime_vertical_radius_m(double latitude_deg) {
  const double s = std::sin(latitude_deg * kDegree);
  return kA / std::sqrt(1.0 - kE2 * s * s);
}
Eigen::Vector3d ecef(const GeodeticPosition& p) {
  const double n = prime_vertical_radius_m(p.latitude_deg);
  const double lat = p.latitude_deg * kDegree, lon = p.longitude_deg * kDegree;
  return {(n + p.height_m) * std::cos(lat) * std::cos(lon),
          (n + p.height_m) * std::cos(lat) * std::sin(lon),
          (n * (1.0 - kE2) + p.height_m) * std::sin(lat)};
}

TEST(FieldGeoreference, SmallStepsFollowTheRadiiOfCurvature) {
  const GeodeticPosition bonn = {50.7, 7.1, 60.0};
  const FieldGeoreference field = *FieldGeoreference::at(bonn, 0.0);
  EXPECT_NEAR(field.to_field(bonn).norm(), 0.0, 1e-9);
  const double step_rad = 1e-6;  // about 6 m
  const Eigen::Vector3d north = field.to_field({50.7 + step_rad / kDegree, 7.1, 60.0});
  EXPECT_NEAR(north.y(), (meridian_radius_m(50.7) + 60.0) * step_rad, 1e-6);
  EXPECT_NEAR(north.x(), 0.0, 1e-8);
  const Eigen::Vector3d east = field.to_field({50.7, 7.1 + step_rad / kDegree, 60.0});
  const double parallel_m = (prime_vertical_radius_m(50.7) + 60.0) * std::cos(50.7 * kDegree);
  EXPECT_NEAR(east.x(), parallel_m * step_rad, 1e-6);
  // The surface falls away from the plane by d^2 / (2 R).
  EXPECT_NEAR(north.z(), -0.5 * north.y() * north.y() / meridian_radius_m(50.7), 1e-7);
  EXPECT_NEAR((field.to_field({50.7, 7.1, 63.0}) - Eigen::Vector3d(0, 0, 3)).norm(), 0.0, 1e-8);
}

TEST(FieldGeoreference, KeepsDistancesInSpace) {
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    const GeodeticPosition origin{random.uniform(-90.0, 90.0), random.uniform(-180.0, 180.0), 50.0};
    const FieldGeoreference field = *FieldGeoreference::at(origin, random.uniform(-kPi, kPi));
    const GeodeticPosition a = field.to_geodetic({random.uniform(-5e3, 5e3), 200.0, 1.0});
    const GeodeticPosition b = field.to_geodetic({-300.0, random.uniform(-5e3, 5e3), 2.0});
    EXPECT_NEAR((field.to_field(a) - field.to_field(b)).norm(), (ecef(a) - ecef(b)).norm(), 1e-7);
  }
}

TEST(FieldGeoreference, RoundTripsWithinAFarmAnywhere) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const FieldGeoreference field = *FieldGeoreference::at(
        {random.uniform(-90.0, 90.0), random.uniform(-180.0, 180.0), random.uniform(-100.0, 3e3)},
        random.uniform(-kPi, kPi));
    const Eigen::Vector3d p(random.uniform(-5e3, 5e3), random.uniform(-5e3, 5e3),
                            random.uniform(-50.0, 50.0));
    EXPECT_NEAR((field.to_field(field.to_geodetic(p)) - p).norm(), 0.0, 1e-7);
    EXPECT_NEAR((field.from_lon_lat_deg(field.to_lon_lat_deg(p.head<2>())) - p.head<2>()).norm(),
                0.0, 1e-7);
  }
}

TEST(FieldGeoreference, AFixOnThePlaneIsWhereAMapPutsIt) {
  // At 1000 m of height a degree is longer than on the ellipsoid: both directions must know it.
  const FieldGeoreference field = *FieldGeoreference::at({50.6, 7.0, 1000.0}, 0.3);
  const Eigen::Vector2d p(300.0, -40.0);
  const GeodeticPosition fix = field.to_geodetic({p.x(), p.y(), 0.0});
  EXPECT_NEAR(
      (field.to_lon_lat_deg(p) - Eigen::Vector2d(fix.longitude_deg, fix.latitude_deg)).norm(), 0.0,
      1e-12);
  EXPECT_NEAR((field.from_lon_lat_deg({fix.longitude_deg, fix.latitude_deg}) - p).norm(), 0.0,
              1e-8);
}

TEST(FieldGeoreference, TheDateLineIsALineAsAnyOther) {
  const FieldGeoreference field = *FieldGeoreference::at({-16.8, 179.9999, 0.0}, 0.0);
  const Eigen::Vector2d beyond = field.from_lon_lat_deg({-179.9999, -16.8});
  const double parallel_m = prime_vertical_radius_m(-16.8) * std::cos(16.8 * kDegree);
  EXPECT_NEAR(beyond.x(), 0.0002 * kDegree * parallel_m, 1e-6);  // about 21.3 m
  EXPECT_NEAR(field.to_lon_lat_deg(beyond).x(), -179.9999, 1e-12);
}

TEST(FieldGeoreference, StandsOnThePolesToo) {
  for (const double latitude : {-90.0, 90.0}) {
    const FieldGeoreference field = *FieldGeoreference::at({latitude, 0.0, 0.0}, 0.0);
    const Eigen::Vector2d p(30.0, 40.0);
    const Eigen::Vector2d lon_lat = field.to_lon_lat_deg(p);
    EXPECT_NEAR((90.0 - std::abs(lon_lat.y())) * kDegree * meridian_radius_m(90.0), 50.0, 1e-4);
    EXPECT_NEAR((field.from_lon_lat_deg(lon_lat) - p).norm(), 0.0, 1e-7);
  }
}

TEST(FieldGeoreference, GivesNoPlaceForTheOtherSideOfTheEarth) {
  const FieldGeoreference field = *FieldGeoreference::at({50.0, 7.0, 0.0}, 0.0);
  for (const Eigen::Vector2d& far :
       {Eigen::Vector2d(-173.0, -50.0), Eigen::Vector2d(30.0, 50.0), Eigen::Vector2d(7.0, 91.0)}) {
    EXPECT_FALSE(field.from_lon_lat_deg(far).allFinite());
  }
}

TEST(FieldGeoreference, RowsPointAsTold) {
  const GeodeticPosition origin = {50.7, 7.1, 60.0};
  const FieldGeoreference east = *FieldGeoreference::at(origin, 0.0);
  // A row to the north: the field's x is north, its y is west.
  const FieldGeoreference north = *FieldGeoreference::at(origin, 0.5 * kPi);
  const Eigen::Vector3d p_F = north.to_field(east.to_geodetic({2.0, 10.0, 0.5}));
  EXPECT_NEAR((p_F - Eigen::Vector3d(10.0, -2.0, 0.5)).norm(), 0.0, 1e-7);
}

TEST(FieldGeoreference, RefusesOriginsThatAreNotOnEarth) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const GeodeticPosition& bad :
       {GeodeticPosition{90.1, 0.0, 0.0}, GeodeticPosition{nan, 0.0, 0.0},
        GeodeticPosition{0.0, 361.0, 0.0}, GeodeticPosition{0.0, nan, 0.0},
        GeodeticPosition{0.0, 0.0, 2e5}, GeodeticPosition{0.0, 0.0, nan}}) {
    EXPECT_FALSE(FieldGeoreference::at(bad, 0.0).ok());
  }
  EXPECT_FALSE(FieldGeoreference::at({}, nan).ok());
}

}  // namespace
}  // namespace furrow::geometry
