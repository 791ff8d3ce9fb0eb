#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::vision {

/// Draws instances on a BGR image: contour (crops green, weeds orange), and stem as a cross. With
/// `labels` the most probable class, score x class score, and area in cm2 stand beside each.
/// @pre image is CV_8UC3 and holds the instances' boxes.
void draw_instances(const std::vector<Instance>& instances, const std::vector<SubClass>& classes,
                    bool labels, cv::Mat& image);

/// Draws annotations in the same way, without labels.
void draw_annotations(const std::vector<AnnotatedInstance>& instances, cv::Mat& image);

}  // namespace furrow::vision
