#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::simulation {

/// Blur, vignetting and noise of lens and sensor.
struct CameraEffectParameters {
  double lens_blur_px = 0.6;
  double motion_blur_px = 0.9;
  double vignetting = 0.15;
  double image_noise = 1.5;
  double depth_noise_m = 0.001;
  double depth_hole_share = 0.005;
  double depth_edge_step_m = 0.015;

  /// No blur, no noise, no holes.
  [[nodiscard]] static CameraEffectParameters none();
  void visit(ParameterVisitor& v);
};

/// Applies blur, vignetting, noise and holes to pictures. Integer arithmetic for colours.
class CameraEffects {
 public:
  CameraEffects(const CameraEffectParameters& parameters, std::uint64_t seed);

  /// Changes `bgr` (8UC3) and `depth_m` (32FC1, same size) in place. Motion blur runs along the
  /// image's columns, or along its rows. `threads` threads share the rows; the bytes do not depend
  /// on their number.
  void apply(cv::Mat& bgr, cv::Mat& depth_m, std::uint64_t frame_index, bool motion_along_columns,
             int threads) const;

 private:
  void filter_rows(const cv::Mat& source, cv::Mat& target, std::uint64_t frame_index,
                   bool motion_along_columns, int first, int last) const;
  void degrade_depth(const cv::Mat& source, cv::Mat& target, std::uint64_t frame_index, int first,
                     int last) const;

  CameraEffectParameters parameters_;
  std::uint64_t seed_;
  std::vector<std::int8_t> noise_;
  std::vector<std::int16_t> lens_kernel_;
  std::vector<std::int16_t> motion_kernel_;
};

}  // namespace furrow::simulation
