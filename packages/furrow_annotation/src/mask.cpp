#include "furrow_annotation/mask.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace furrow::annotation {
namespace {

/// Calls `visit(u, v)` for each pixel that is set, in image coordinates.
template <class Visit>
void each_pixel(const AnnotatedInstance& instance, const Visit& visit) {
  for (int row = 0; row < instance.mask.rows; ++row) {
    const auto* pixels = instance.mask.ptr<std::uint8_t>(row);
    for (int column = 0; column < instance.mask.cols; ++column) {
      if (pixels[column] != 0) {
        visit(static_cast<double>(instance.box_px.x + column),
              static_cast<double>(instance.box_px.y + row));
      }
    }
  }
}

}  // namespace

bool cut_to_box(const cv::Mat& full_mask, AnnotatedInstance& instance) {
  const cv::Rect box = cv::boundingRect(full_mask);
  if (box.empty()) return false;
  instance.box_px = box;
  instance.mask = full_mask(box).clone();
  return true;
}

MaskMeasures measure(const AnnotatedInstance& instance) {
  MaskMeasures measures;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  each_pixel(instance, [&](double u, double v) {
    sum += Eigen::Vector2d(u, v);
    measures.area_px2 += 1.0;
  });
  if (measures.area_px2 > 0.0) measures.centroid_px = sum / measures.area_px2;
  return measures;
}

double reach_px(const AnnotatedInstance& instance, const Eigen::Vector2d& from_px) {
  double farthest = 0.0;
  each_pixel(instance, [&](double u, double v) {
    farthest = std::max(farthest, std::hypot(u - from_px.x(), v - from_px.y()));
  });
  return farthest;
}

}  // namespace furrow::annotation
