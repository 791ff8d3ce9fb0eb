#pragma once

#include <opencv2/core/types.hpp>

#include "furrow_annotation/read_report.hpp"
#include "furrow_annotation/run_lengths.hpp"
#include "json_node.hpp"

namespace furrow::annotation {

struct Segmentation {
  BoxedMask mask;  ///< holds a pixel
  bool box_only = false;
};

/// The mask of an annotation: of its "segmentation", else of its "bbox". Throws Malformed. With a
/// report, polygons of fewer than three corners are skipped and counted when the annotation has
/// good ones too. Without a report (strict) they are malformed.
[[nodiscard]] Segmentation read_segmentation(const JsonNode& annotation, cv::Size size,
                                             ReadReport* report);

/// [x, y, width, height] in COCO's coordinates, as the pixels inside the image. Throws Malformed.
[[nodiscard]] cv::Rect read_box(const JsonNode& node, cv::Size size);

}  // namespace furrow::annotation
