#include "furrow_vision/detector.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/statistics.hpp"

namespace furrow::vision {
namespace {

std::string size_text(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Error invalid(std::string message) {
  return {ErrorCode::kInvalidArgument, std::move(message)};
}

bool is_depth(float depth_m) {
  return std::isfinite(depth_m) && depth_m > 0.0f;
}

struct MedianDepths {
  double ground_m = 0.0;
  double canopy_m = 0.0;
};

/// Of the soil around a plant and of the plant; nothing where either is not known.
std::optional<MedianDepths> depths_at(const RgbdView& view, const cv::Mat& vegetation,
                                      const Instance& instance) {
  if (view.depth_m.empty() || !instance.depth_measured) return std::nullopt;
  constexpr std::size_t kMinSamples = 10;
  const cv::Rect& box = instance.box_px;
  const int margin = std::max(4, std::max(box.width, box.height) / 8);
  const cv::Rect around =
      cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
      cv::Rect(cv::Point(), view.bgr.size());
  // A sample of the pixels gives the medians as well.
  const int step = std::max(1, std::min(box.width, box.height) / 32);
  std::vector<float> ground, canopy;
  for (int v = around.y; v < around.y + around.height; v += step) {
    const float* depth = view.depth_m.ptr<float>(v);
    const auto* plants = vegetation.ptr<std::uint8_t>(v);
    for (int u = around.x; u < around.x + around.width; u += step) {
      if (!is_depth(depth[u])) continue;
      if (plants[u] == 0) {
        ground.push_back(depth[u]);
      } else if (box.contains({u, v}) &&
                 instance.mask.at<std::uint8_t>(v - box.y, u - box.x) != 0) {
        canopy.push_back(depth[u]);
      }
    }
  }
  if (ground.size() < kMinSamples || canopy.empty()) return std::nullopt;
  return MedianDepths{median_element(std::span(ground)), median_element(std::span(canopy))};
}

}  // namespace

Status check_view(const RgbdView& view) {
  const cv::Size size = view.bgr.size();
  if (view.bgr.empty()) return invalid("image is empty");
  if (view.bgr.dims != 2 || view.bgr.type() != CV_8UC3) {
    return invalid("image must have three channels of 8 bits (BGR), not " +
                   std::to_string(view.bgr.channels()) + " of " +
                   std::to_string(8 * static_cast<int>(view.bgr.elemSize1())) + " bits");
  }
  if (size.width > kMaxImageSide_px || size.height > kMaxImageSide_px ||
      static_cast<std::int64_t>(size.width) * size.height > kMaxImageArea_px) {
    return invalid("image of " + size_text(size) + " pixels is larger than allowed");
  }
  const auto& intrinsics = view.camera.intrinsics();
  if (size != cv::Size(intrinsics.width_px, intrinsics.height_px)) {
    return invalid("image is " + size_text(size) + ", the camera " +
                   size_text({intrinsics.width_px, intrinsics.height_px}));
  }
  if (!view.depth_m.empty()) {
    if (view.depth_m.dims != 2 || view.depth_m.type() != CV_32FC1) {
      return invalid("depth must have one channel of 32-bit floats in metres");
    }
    if (view.depth_m.size() != size) {
      return invalid("depth is " + size_text(view.depth_m.size()) + ", the image " +
                     size_text(size));
    }
  }
  if (!std::isfinite(view.ground_distance_m) || view.ground_distance_m <= 0.0) {
    return invalid("ground distance must be positive and finite");
  }
  const auto finite = [](double u) { return std::isfinite(u); };
  if (!std::all_of(view.crop_row_u_px.begin(), view.crop_row_u_px.end(), finite)) {
    return invalid("a crop row's column is not finite");
  }
  return {};
}

double crop_probability(const std::vector<double>& class_scores,
                        const std::vector<SubClass>& classes) {
  double sum = 0.0;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i].kind == SubClassKind::kCrop) sum += class_scores[i];
  }
  return sum;
}

void shift_towards_crops(double log_odds, const std::vector<SubClass>& classes,
                         std::vector<double>& class_scores) {
  if (log_odds == 0.0) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i].kind == SubClassKind::kCrop) class_scores[i] *= std::exp(log_odds);
    sum += class_scores[i];
  }
  for (double& score : class_scores) score /= sum;
}

void measure_instance(const RgbdView& view, Instance& instance) {
  const cv::Rect& box = instance.box_px;
  std::vector<float> depths;
  int pixels = 0;
  double squares_m2 = 0.0;  // of the depths that are there
  double farthest_px2 = 0.0;
  for (int v = 0; v < box.height; ++v) {
    const auto* mask = instance.mask.ptr<std::uint8_t>(v);
    const float* depth =
        view.depth_m.empty() ? nullptr : view.depth_m.ptr<float>(box.y + v) + box.x;
    for (int u = 0; u < box.width; ++u) {
      if (mask[u] == 0) continue;
      ++pixels;
      const double du = box.x + u - instance.stem_px.x();
      const double dv = box.y + v - instance.stem_px.y();
      farthest_px2 = std::max(farthest_px2, du * du + dv * dv);
      if (depth != nullptr && is_depth(depth[u])) {
        depths.push_back(depth[u]);
        squares_m2 += static_cast<double>(depth[u]) * depth[u];
      }
    }
  }
  instance.depth_measured = !depths.empty() && static_cast<int>(depths.size()) * 10 >= pixels;
  double fill_m = view.ground_distance_m;
  if (instance.depth_measured) {
    fill_m = median_element(std::span(depths));
  } else {
    depths.clear();
    squares_m2 = 0.0;
  }
  const int holes = pixels - static_cast<int>(depths.size());
  // The area of a pixel grows with the square of its depth, so that squares can be summed.
  instance.area_mm2 = view.camera.pixel_area_mm2(1.0) * (squares_m2 + holes * fill_m * fill_m);
  instance.stem_depth_m = fill_m;
  if (instance.depth_measured) {
    const cv::Point at(static_cast<int>(std::lround(instance.stem_px.x())),
                       static_cast<int>(std::lround(instance.stem_px.y())));
    const bool inside = cv::Rect(cv::Point(), view.depth_m.size()).contains(at);
    if (inside && is_depth(view.depth_m.at<float>(at))) {
      instance.stem_depth_m = view.depth_m.at<float>(at);
    }
  }
  const auto& intrinsics = view.camera.intrinsics();
  instance.radius_m = std::sqrt(farthest_px2) * instance.stem_depth_m /
                      std::sqrt(intrinsics.fx_px * intrinsics.fy_px);
  instance.touches_border = box.x == 0 || box.y == 0 || box.x + box.width == view.bgr.cols ||
                            box.y + box.height == view.bgr.rows;
}

void place_stem_on_ground(const RgbdView& view, const cv::Mat& vegetation, Instance& instance) {
  const auto depths = depths_at(view, vegetation, instance);
  if (!depths) return;
  const double ratio = depths->canopy_m / depths->ground_m;
  instance.stem_depth_m = depths->ground_m;
  if (ratio >= 1.0) return;
  const auto& intrinsics = view.camera.intrinsics();
  const Eigen::Vector2d axis(intrinsics.cx_px, intrinsics.cy_px);
  instance.stem_px = axis + ratio * (instance.stem_px - axis);
}

void set_stem_depth_to_ground(const RgbdView& view, const cv::Mat& vegetation, Instance& instance) {
  if (const auto depths = depths_at(view, vegetation, instance)) {
    instance.stem_depth_m = depths->ground_m;
  }
}

}  // namespace furrow::vision
