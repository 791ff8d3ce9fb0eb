#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_geometry/camera.hpp"
#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/detector_choice.hpp"

namespace furrow::cli {

/// What the verbs that look at images have in common.
struct VisionOptions {
  std::vector<std::string> detectors;
  std::vector<std::string> models;
  std::vector<std::string> settings;
  std::optional<double> resolution_mm_per_px;
};

void add_vision_options(CLI::App* command, VisionOptions& options);

struct NamedDetector {
  std::string name;
  std::unique_ptr<vision::Detector> detector;
};

/// Those asked for; where none are, the index and every shipped or given model. A model given goes
/// to the detector of its kind. Throws ConfigError.
[[nodiscard]] std::vector<NamedDetector> make_detectors(const VisionOptions& options);

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

}  // namespace furrow::cli
