#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "furrow_annotation/dataset.hpp"

namespace furrow::annotation {

/// Sets box and mask of `instance` from a CV_8U mask over the whole image. Returns false, and
/// changes nothing, when no pixel is set.
[[nodiscard]] bool cut_to_box(const cv::Mat& full_mask, AnnotatedInstance& instance);

/// Size and place of a plant in its image.
struct MaskMeasures {
  double area_px2 = 0.0;                                  ///< number of pixels
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();  ///< mean of the pixels' centres
};
/// @pre the mask holds a pixel.
[[nodiscard]] MaskMeasures measure(const AnnotatedInstance& instance);

/// Distance from a point to the farthest pixel centre of the mask.
[[nodiscard]] double reach_px(const AnnotatedInstance& instance, const Eigen::Vector2d& from_px);

}  // namespace furrow::annotation
