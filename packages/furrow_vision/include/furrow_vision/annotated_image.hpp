#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "furrow_annotation/dataset.hpp"
#include "furrow_core/result.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::vision {

using annotation::AnnotatedImage;
using annotation::AnnotatedInstance;
using annotation::Dataset;

/// Reads the pixels, turned as the file's EXIF orientation says (Carrot-Weed's masks are drawn on
/// the turned images). Error: not there, not an image, or not of the size that the annotation
/// names.
[[nodiscard]] Status load_pixels(AnnotatedImage& image);

/// Semantic labels, CV_8U: 0 soil, 1 weed, 2 crop; where instances overlap the later one counts.
[[nodiscard]] cv::Mat semantic_labels(const AnnotatedImage& image);

/// Detections as annotations, each of its most probable class.
[[nodiscard]] std::vector<AnnotatedInstance> to_annotations(const std::vector<Instance>& instances,
                                                            const std::vector<SubClass>& classes);

}  // namespace furrow::vision
