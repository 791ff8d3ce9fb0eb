#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace furrow::vision {

/// Lengths in pixels of the mask given.
struct GroupingParameters {
  double min_area_px = 4.0;
  double merge_gap_min_px = 1.5;
  double merge_gap_factor = 0.35;
  double merge_gap_max_px = 5.0;
  double closing_factor = 0.14;
  double split_saddle_ratio = 0.55;
  double split_min_area_px = 120.0;
  double stem_kernel_factor = 2.0;
  int max_plants = 2000;
};

struct PlantGroups {
  cv::Mat labels;                        ///< CV_32S; 0 nothing, i + 1 the i-th plant
  std::vector<Eigen::Vector2d> stem_px;  ///< one a plant
};

/// Puts the pieces of a vegetation mask (CV_8U) together into plants and splits plants that touch.
[[nodiscard]] PlantGroups group_plants(const cv::Mat& mask, const GroupingParameters& parameters);

}  // namespace furrow::vision
