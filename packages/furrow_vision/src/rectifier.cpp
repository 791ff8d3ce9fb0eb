#include "furrow_vision/rectifier.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "furrow_annotation/dataset.hpp"

namespace furrow::vision {
namespace {

struct Model {
  const char* name;
  std::size_t coefficients;
};
constexpr Model kModels[] = {{"plumb_bob", 5}, {"rational_polynomial", 8}, {"equidistant", 4}};
constexpr const char* kEquidistant = "equidistant";

Status check(const geometry::Distortion& distortion) {
  const auto* const model = std::ranges::find_if(
      kModels, [&](const Model& known) { return known.name == distortion.model; });
  if (model == std::end(kModels)) {
    return Error{ErrorCode::kInvalidArgument,
                 "distortion model '" + distortion.model +
                     "'; plumb_bob, rational_polynomial and equidistant are read"};
  }
  if (distortion.coefficients.size() != model->coefficients) {
    return Error{ErrorCode::kInvalidArgument, "distortion model " + distortion.model + " has " +
                                                  std::to_string(model->coefficients) +
                                                  " coefficients, not " +
                                                  std::to_string(distortion.coefficients.size())};
  }
  if (!std::ranges::all_of(distortion.coefficients, [](double c) { return std::isfinite(c); })) {
    return Error{ErrorCode::kInvalidArgument, "a coefficient of the distortion is not finite"};
  }
  return {};
}

}  // namespace

Result<Rectifier> Rectifier::make(const geometry::CameraIntrinsics& intrinsics,
                                  const geometry::Distortion& distortion) {
  Rectifier rectifier;
  const auto is_zero = [](double c) { return c == 0.0; };
  // A rectified stream comes with any model's name and zeros, or with no coefficients at all.
  if (distortion.model != kEquidistant && std::ranges::all_of(distortion.coefficients, is_zero)) {
    return rectifier;
  }
  if (const Status checked = check(distortion); !checked.ok()) return checked.error();
  if (intrinsics.width_px > annotation::kMaxImageSide_px ||
      intrinsics.height_px > annotation::kMaxImageSide_px) {
    return Error{ErrorCode::kInvalidArgument, "the camera has more pixels than allowed"};
  }
  const cv::Matx33d matrix(intrinsics.fx_px, 0.0, intrinsics.cx_px,  //
                           0.0, intrinsics.fy_px, intrinsics.cy_px,  //
                           0.0, 0.0, 1.0);
  const cv::Size size(intrinsics.width_px, intrinsics.height_px);
  const auto rotation = cv::Matx33d::eye();
  if (distortion.model == kEquidistant) {
    cv::fisheye::initUndistortRectifyMap(matrix, distortion.coefficients, rotation, matrix, size,
                                         CV_32FC1, rectifier.map_x_, rectifier.map_y_);
  } else {
    cv::initUndistortRectifyMap(matrix, distortion.coefficients, rotation, matrix, size, CV_32FC1,
                                rectifier.map_x_, rectifier.map_y_);
  }
  return rectifier;
}

cv::Mat Rectifier::colour(const cv::Mat& image) const {
  if (identity()) return image;
  cv::Mat rectified;
  cv::remap(image, rectified, map_x_, map_y_, cv::INTER_LINEAR);
  return rectified;
}

cv::Mat Rectifier::depth(const cv::Mat& image) const {
  if (identity()) return image;
  cv::Mat rectified;
  cv::remap(image, rectified, map_x_, map_y_, cv::INTER_NEAREST);
  return rectified;
}

}  // namespace furrow::vision
