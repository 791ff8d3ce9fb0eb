#include "furrow_localization/geodetic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "furrow_core/random.hpp"

namespace furrow::localization {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kA = kWgs84SemiMajorAxis_m;
const double kB = kA * (1.0 - kWgs84Flattening);
const double kE2 = 1.0 - kB * kB / (kA * kA);

/// Radius of curvature along the meridian, and of the prime vertical.
double meridian_radius_m(double latitude_rad) {
  return kA * (1.0 - kE2) / std::pow(1.0 - kE2 * std::pow(std::sin(latitude_rad), 2), 1.5);
}
double prime_vertical_radius_m(double latitude_rad) {
  return kA / std::sqrt(1.0 - kE2 * std::pow(std::sin(latitude_rad), 2));
}

TEST(Geodetic, AxesOfTheEllipsoidAreWhereTheyMustBe) {
  EXPECT_NEAR((geodetic_to_ecef({0.0, 0.0, 0.0}) - Eigen::Vector3d(kA, 0, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((geodetic_to_ecef({0.0, 0.5 * kPi, 5.0}) - Eigen::Vector3d(0, kA + 5.0, 0)).norm(),
              0.0, 1e-8);
  EXPECT_NEAR((geodetic_to_ecef({0.5 * kPi, 0.0, 7.0}) - Eigen::Vector3d(0, 0, kB + 7.0)).norm(),
              0.0, 1e-8);
}

TEST(Geodetic, PointsOnTheSurfaceSatisfyItsEquation) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p =
        geodetic_to_ecef({random.uniform(-1.57, 1.57), random.uniform(-kPi, kPi), 0.0});
    EXPECT_NEAR(std::pow(p.head<2>().norm() / kA, 2) + std::pow(p.z() / kB, 2), 1.0, 1e-14);
  }
}

TEST(Geodetic, EcefRoundTripsEverywhere) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const GeodeticPosition position = {random.uniform(-0.5 * kPi, 0.5 * kPi),
                                       random.uniform(-kPi, kPi), random.uniform(-1e4, 1e5)};
    const GeodeticPosition back = ecef_to_geodetic(geodetic_to_ecef(position));
    EXPECT_NEAR(back.latitude_rad, position.latitude_rad, 1e-8 / kA);
    EXPECT_NEAR(back.height_m, position.height_m, 1e-8);
    const double east = std::cos(position.latitude_rad) *
                        std::remainder(back.longitude_rad - position.longitude_rad, 2.0 * kPi);
    EXPECT_NEAR(east, 0.0, 1e-8 / kA);
  }
  const GeodeticPosition pole = ecef_to_geodetic({0.0, 0.0, -kB - 12.0});
  EXPECT_NEAR(pole.latitude_rad, -0.5 * kPi, 1e-12);
  EXPECT_NEAR(pole.height_m, 12.0, 1e-8);
  EXPECT_EQ(pole.longitude_rad, 0.0);
}

TEST(LocalTangentPlane, SmallStepsFollowTheRadiiOfCurvature) {
  const GeodeticPosition bonn = {50.7 * kDegree, 7.1 * kDegree, 60.0};
  const LocalTangentPlane plane = *LocalTangentPlane::at(bonn);
  EXPECT_NEAR(plane.to_enu(bonn).norm(), 0.0, 1e-9);
  const double step_rad = 1e-6;  // about 6 m
  const Eigen::Vector3d north =
      plane.to_enu({bonn.latitude_rad + step_rad, bonn.longitude_rad, bonn.height_m});
  EXPECT_NEAR(north.y(), (meridian_radius_m(bonn.latitude_rad) + 60.0) * step_rad, 1e-6);
  EXPECT_NEAR(north.x(), 0.0, 1e-8);
  const Eigen::Vector3d east =
      plane.to_enu({bonn.latitude_rad, bonn.longitude_rad + step_rad, bonn.height_m});
  const double parallel_m =
      (prime_vertical_radius_m(bonn.latitude_rad) + 60.0) * std::cos(bonn.latitude_rad);
  EXPECT_NEAR(east.x(), parallel_m * step_rad, 1e-6);
  // The surface falls away from the plane by d^2 / (2 R).
  EXPECT_NEAR(north.z(), -0.5 * north.y() * north.y() / meridian_radius_m(bonn.latitude_rad), 1e-7);
  const Eigen::Vector3d up =
      plane.to_enu({bonn.latitude_rad, bonn.longitude_rad, bonn.height_m + 3.0});
  EXPECT_NEAR((up - Eigen::Vector3d(0, 0, 3)).norm(), 0.0, 1e-8);
}

TEST(LocalTangentPlane, RoundTripsWithinAFarm) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const LocalTangentPlane plane = *LocalTangentPlane::at(
        {random.uniform(-1.5, 1.5), random.uniform(-kPi, kPi), random.uniform(-100.0, 3000.0)});
    const Eigen::Vector3d p(random.uniform(-5e3, 5e3), random.uniform(-5e3, 5e3),
                            random.uniform(-50.0, 50.0));
    EXPECT_NEAR((plane.to_enu(plane.to_geodetic(p)) - p).norm(), 0.0, 1e-7);
  }
}

TEST(FieldGeoreference, RowsPointAsTold) {
  const GeodeticPosition origin = {50.7 * kDegree, 7.1 * kDegree, 60.0};
  const LocalTangentPlane plane = *LocalTangentPlane::at(origin);
  // A row to the north: the field's x is north, its y is west.
  const FieldGeoreference field = *FieldGeoreference::at(origin, 0.5 * kPi);
  const Eigen::Vector3d p_F = field.to_field(plane.to_geodetic({2.0, 10.0, 0.5}));
  EXPECT_NEAR((p_F - Eigen::Vector3d(10.0, -2.0, 0.5)).norm(), 0.0, 1e-7);
  const FieldGeoreference oblique = *FieldGeoreference::at(origin, 0.3);
  const Eigen::Vector3d q(31.0, -4.0, 0.2);
  EXPECT_NEAR((oblique.to_field(oblique.to_geodetic(q)) - q).norm(), 0.0, 1e-7);
}

TEST(LocalTangentPlane, RefusesOriginsThatAreNotOnEarth) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const GeodeticPosition& bad :
       {GeodeticPosition{1.6, 0.0, 0.0}, GeodeticPosition{nan, 0.0, 0.0},
        GeodeticPosition{0.0, 7.0, 0.0}, GeodeticPosition{0.0, nan, 0.0},
        GeodeticPosition{0.0, 0.0, 2e5}, GeodeticPosition{0.0, 0.0, nan}}) {
    EXPECT_FALSE(LocalTangentPlane::at(bad).ok());
    EXPECT_FALSE(FieldGeoreference::at(bad, 0.0).ok());
  }
  EXPECT_FALSE(FieldGeoreference::at({}, nan).ok());
}

}  // namespace
}  // namespace furrow::localization
