#include "furrow_evaluation/loaded_image.hpp"

#include <optional>
#include <span>
#include <vector>

#include "furrow_core/statistics.hpp"
#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::evaluation {
namespace {

/// Half of the pixels that have a depth are nearer.
std::optional<double> median_depth_m(const cv::Mat& depth_m) {
  std::vector<float> depths;
  constexpr int kStep = 4;  // a sample is enough
  for (int v = 0; v < depth_m.rows; v += kStep) {
    for (int u = 0; u < depth_m.cols; u += kStep) {
      const float depth = depth_m.at<float>(v, u);
      if (depth > 0.0f) depths.push_back(depth);
    }
  }
  if (depths.empty()) return std::nullopt;
  return median_element(std::span(depths));
}

}  // namespace

Result<LoadedImage> load_image(annotation::AnnotatedImage& image, double resolution_mm_per_px) {
  if (const Status loaded = vision::load_pixels(image); !loaded.ok()) return loaded.error();
  const double focal_px = 1000.0 / resolution_mm_per_px;
  LoadedImage result{
      .bgr = image.bgr,
      .depth_m = {},
      .camera = geometry::PinholeCamera({image.bgr.cols, image.bgr.rows, focal_px, focal_px,
                                         0.5 * (image.bgr.cols - 1), 0.5 * (image.bgr.rows - 1)})};
  if (image.depth_path.empty()) return result;
  const auto read = vision::read_image(image.depth_path, vision::ImageChannels::kAsStored);
  if (!read.ok()) return read.error();
  const cv::Mat& depth = *read;
  if (depth.type() != CV_16UC1 || depth.size() != image.bgr.size()) {
    return Error{ErrorCode::kParse,
                 image.depth_path.string() + ": is not a 16-bit depth image of the picture's size"};
  }
  constexpr double kUnit_m = 1e-4;
  depth.convertTo(result.depth_m, CV_32F, kUnit_m);
  result.ground_distance_m = median_depth_m(result.depth_m).value_or(1.0);
  return result;
}

}  // namespace furrow::evaluation
