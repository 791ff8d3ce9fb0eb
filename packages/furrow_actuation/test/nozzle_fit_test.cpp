#include "furrow_actuation/nozzle_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"

namespace furrow::actuation {
namespace {

/// What a nozzle prints that is `delay_s` late and whose sprays land `beside_m` off.
std::vector<LandingOffset> prints(double delay_s, const Eigen::Vector2d& beside_m,
                                  double noise_m = 0.0) {
  Random random(5, "prints");
  std::vector<LandingOffset> sprays;
  for (const double speed_mps : {0.3, 0.6, 0.9}) {
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d noise(random.normal(0.0, 1.0), random.normal(0.0, 1.0));
      sprays.push_back(
          {speed_mps, beside_m + Eigen::Vector2d(delay_s * speed_mps, 0.0) + noise_m * noise});
    }
  }
  return sprays;
}

TEST(NozzleFit, TellsDelayAndOffsetApart) {
  const auto fit = fit_nozzle({}, prints(0.020, {0.003, -0.002}));
  ASSERT_TRUE(fit.ok());
  EXPECT_NEAR(fit->delay_change_s, 0.020, 1e-9);
  EXPECT_NEAR(fit->calibration.open_delay_s, NozzleCalibration{}.open_delay_s + 0.020, 1e-9);
  EXPECT_NEAR(fit->calibration.close_delay_s, NozzleCalibration{}.close_delay_s + 0.020, 1e-9);
  EXPECT_NEAR(fit->calibration.offset_x_m, 0.003, 1e-9);
  EXPECT_NEAR(fit->calibration.offset_y_m, -0.002, 1e-9);
  EXPECT_EQ(fit->calibration.flow_mlps, NozzleCalibration{}.flow_mlps);
}

TEST(NozzleFit, ChangesNothingWhereNothingIsOff) {
  const auto fit = fit_nozzle({}, prints(0.0, {0.0, 0.0}));
  ASSERT_TRUE(fit.ok());
  EXPECT_EQ(fit->delay_change_s, 0.0);
  EXPECT_EQ(fit->offset_change_m, Eigen::Vector2d::Zero());
}

TEST(NozzleFit, ABlotchOnThePaperDoesNoHarm) {
  auto sprays = prints(0.020, {0.003, -0.002}, 0.0005);
  for (std::size_t i : {1u, 9u, 17u, 20u}) sprays[i].offset_m = {0.3, -0.4};
  const auto fit = fit_nozzle({}, sprays);
  ASSERT_TRUE(fit.ok());
  EXPECT_NEAR(fit->delay_change_s, 0.020, 0.002);
  EXPECT_NEAR(fit->calibration.offset_x_m, 0.003, 0.001);
  EXPECT_NEAR(fit->calibration.offset_y_m, -0.002, 0.001);
}

TEST(NozzleFit, RefusesWhatCannotBeFitted) {
  auto sprays = prints(0.020, {0.0, 0.0});
  const std::span<const LandingOffset> all(sprays);
  EXPECT_EQ(fit_nozzle({}, {}).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(fit_nozzle({}, all.first(5)).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(fit_nozzle({}, all.first(8)).error().code, ErrorCode::kInvalidArgument);  // one speed
  EXPECT_EQ(fit_nozzle({}, prints(-0.020, {0.0, 0.0})).error().code, ErrorCode::kOutOfRange);
  sprays[3].offset_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_nozzle({}, sprays).error().code, ErrorCode::kInvalidArgument);
}

TEST(DistanceQuantile, InterpolatesBetweenDistances) {
  const std::vector<LandingOffset> sprays = {{0.5, {0.003, 0.004}}, {0.5, {0.0, 0.001}}};
  EXPECT_FALSE(distance_quantile_m({}, 0.5).has_value());
  EXPECT_NEAR(*distance_quantile_m(sprays, 0.0), 0.001, 1e-12);
  EXPECT_NEAR(*distance_quantile_m(sprays, 0.5), 0.003, 1e-12);
  EXPECT_NEAR(*distance_quantile_m(sprays, 1.0), 0.005, 1e-12);
}

}  // namespace
}  // namespace furrow::actuation
