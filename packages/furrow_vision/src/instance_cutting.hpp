#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "furrow_vision/detector.hpp"

namespace furrow::vision {

/// Boxes and masks of plants at full resolution from their labels on a coarser grid. `labels` is
/// CV_32S, 0 nothing, i + 1 the i-th of `count` plants; `cells_per_px` (u, v) leads from pixels to
/// cells, and what lies beyond the last cell belongs to it. A pixel takes the label of its cell, or
/// that of a neighbouring one where the cell has none. Entry i of the result is plant i; where no
/// pixel is left to it, its box and mask are empty.
[[nodiscard]] std::vector<Instance> cut_instances(const cv::Mat& mask, const cv::Mat& labels,
                                                  const cv::Point2d& cells_per_px,
                                                  std::size_t count);

}  // namespace furrow::vision
