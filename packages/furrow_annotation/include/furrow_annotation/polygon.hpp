#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <vector>

#include "furrow_annotation/run_lengths.hpp"

namespace furrow::annotation {

/// Corners in COCO's coordinates, measured from the upper left CORNER of the image: the pixel of
/// column c covers [c, c + 1). The last corner joins the first.
using CornerPolygon = std::vector<Eigen::Vector2d>;

/// Run lengths of the pixels whose centres are inside, by the even-odd rule. Corners are rounded to
/// a fifth of a pixel, and edges are stepped on that grid. COCO's reference implementation
/// (pycocotools, mask.frPoly) does the same; masks and areas agree with it. No pixel is set for a
/// polygon without area or outside the image. Cost: five steps for each pixel of the outline.
/// @pre coordinates are finite and at most 1e6 from 0; size is not empty.
[[nodiscard]] RunLengths polygon_run_lengths(const CornerPolygon& polygon, cv::Size size);

/// Pixels set in any of the masks. @pre all are of one size.
[[nodiscard]] RunLengths unite(const std::vector<RunLengths>& masks);

}  // namespace furrow::annotation
