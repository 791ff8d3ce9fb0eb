#include "furrow_components/axis_trace.hpp"

#include <gtest/gtest.h>

namespace furrow::components {
namespace {

TEST(AxisTrace, IsCubicBetweenTheMeasurementsAndLinearOutside) {
  const auto position = [](double t) { return 0.1 + 0.5 * t - 3.0 * t * t + 20.0 * t * t * t; };
  const auto velocity = [](double t) { return 0.5 - 6.0 * t + 60.0 * t * t; };
  const auto measured = [&](double t) {
    return AxisPoint{Time::from_seconds(t), position(t), velocity(t)};
  };
  const AxisPoint first = measured(1.00);
  const AxisPoint last = measured(1.02);
  for (const double t : {1.00, 1.003, 1.01, 1.019, 1.02}) {
    const AxisPoint at = axis_at(first, last, Time::from_seconds(t));
    EXPECT_NEAR(at.position_m, position(t), 1e-9) << t;
    EXPECT_NEAR(at.velocity_mps, velocity(t), 1e-6) << t;
  }
  EXPECT_NEAR(axis_at(first, last, Time::from_seconds(0.99)).position_m,
              position(1.0) - 0.01 * velocity(1.0), 1e-9);
  EXPECT_NEAR(axis_at(first, last, Time::from_seconds(1.05)).position_m,
              position(1.02) + 0.03 * velocity(1.02), 1e-9);
}

TEST(AxisTrace, TwoMeasurementsOfOneTimeAreOne) {
  const AxisPoint point{Time::from_seconds(2.0), 0.3, 0.1};
  EXPECT_EQ(axis_at(point, point, point.time).position_m, 0.3);
  EXPECT_NEAR(axis_at(point, point, Time::from_seconds(2.1)).position_m, 0.31, 1e-12);
}

}  // namespace
}  // namespace furrow::components
