#pragma once

#include <opencv2/core.hpp>

#include "furrow_annotation/dataset.hpp"
#include "furrow_core/result.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::evaluation {

/// An image as a detector takes it. `bgr` and `depth_m` are what the view borrows.
struct LoadedImage {
  cv::Mat bgr;
  cv::Mat depth_m;  ///< empty: none
  geometry::PinholeCamera camera;
  double ground_distance_m = 1.0;

  [[nodiscard]] vision::RgbdView view() const {
    return {
        .bgr = bgr, .depth_m = depth_m, .camera = camera, .ground_distance_m = ground_distance_m};
  }
};

/// Reads pixels and depth, where there is one, into image and result. The camera is taken to look
/// straight down, at `resolution_mm_per_px` from 1 m above the ground: where there is depth, its
/// median is the ground's distance.
[[nodiscard]] Result<LoadedImage> load_image(annotation::AnnotatedImage& image,
                                             double resolution_mm_per_px);

}  // namespace furrow::evaluation
