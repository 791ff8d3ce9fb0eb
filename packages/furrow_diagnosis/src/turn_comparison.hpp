#pragma once

#include <vector>

#include "furrow_diagnosis/observation.hpp"

namespace furrow::diagnosis {

inline constexpr double kShortestPath_m = 0.05;
inline constexpr double kLargestScaleError = 0.3;
inline constexpr double kDegPerRad = 57.29577951308232;

/// Turn of the gyroscope against that of the wheels.
struct Turn {
  bool turned = false;       ///< one of both turned enough to compare
  double gain = 0.0;         ///< gyroscope by wheels, least squares
  double correlation = 0.0;  ///< -1 to 1
  double imu_rms_radps = 0.0;
  double wheels_rms_radps = 0.0;
};
/// Pairs samples by arrival, so that other clocks do not matter.
[[nodiscard]] Turn turn_of(const std::vector<ImuSample>& imu,
                           const std::vector<WheelSample>& wheels);

/// Of the poses, from sample to sample.
[[nodiscard]] double path_length_m(const std::vector<WheelSample>& wheels);
/// Whether the ratio of two measures is within kLargestScaleError of `wanted`.
[[nodiscard]] bool near_ratio(double ratio, double wanted);

}  // namespace furrow::diagnosis
