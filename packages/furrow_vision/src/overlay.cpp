#include "furrow_vision/overlay.hpp"

#include <algorithm>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string>

namespace furrow::vision {
namespace {

const cv::Scalar kCropColour(80, 220, 60);
const cv::Scalar kWeedColour(20, 110, 255);

/// Lines that can be seen on large images as on small ones.
int line_width(const cv::Mat& image) {
  return std::max(1, image.cols / 900);
}

void draw_contour(const cv::Rect& box, const cv::Mat& mask, const cv::Scalar& colour,
                  cv::Mat& image) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE, box.tl());
  cv::drawContours(image, contours, -1, colour, line_width(image), cv::LINE_AA);
}

void draw_stem(const Eigen::Vector2d& stem_px, cv::Mat& image) {
  constexpr double kFar_px = 1e6;
  if (!(stem_px.cwiseAbs().maxCoeff() < kFar_px)) return;
  const cv::Point at(cvRound(stem_px.x()), cvRound(stem_px.y()));
  cv::drawMarker(image, at, cv::Scalar::all(0), cv::MARKER_CROSS, 11 * line_width(image),
                 line_width(image) + 2);
  cv::drawMarker(image, at, cv::Scalar::all(255), cv::MARKER_CROSS, 9 * line_width(image),
                 line_width(image));
}

}  // namespace

void draw_instances(const std::vector<Instance>& instances, const std::vector<SubClass>& classes,
                    bool labels, cv::Mat& image) {
  for (const Instance& instance : instances) {
    const bool crop = instance.crop_probability >= 0.5;
    draw_contour(instance.box_px, instance.mask, crop ? kCropColour : kWeedColour, image);
    draw_stem(instance.stem_px, image);
  }
  if (!labels) return;
  const double size = 0.4 * line_width(image);
  for (const Instance& instance : instances) {
    const auto best = std::max_element(instance.class_scores.begin(), instance.class_scores.end());
    const auto index = static_cast<std::size_t>(best - instance.class_scores.begin());
    char figures[64];
    std::snprintf(figures, sizeof figures, " %.2f %.1fcm2", instance.score * *best,
                  instance.area_mm2 / 100.0);
    const std::string text = classes[index].name + figures;
    const cv::Point at(instance.box_px.x, std::max(10 * line_width(image), instance.box_px.y - 3));
    cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(0),
                line_width(image) + 2, cv::LINE_AA);
    cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(255),
                line_width(image), cv::LINE_AA);
  }
}

void draw_annotations(const std::vector<AnnotatedInstance>& instances, cv::Mat& image) {
  for (const AnnotatedInstance& instance : instances) {
    draw_contour(instance.box_px, instance.mask,
                 instance.kind == SubClassKind::kCrop ? kCropColour : kWeedColour, image);
    if (instance.stem_px) draw_stem(*instance.stem_px, image);
  }
}

}  // namespace furrow::vision
