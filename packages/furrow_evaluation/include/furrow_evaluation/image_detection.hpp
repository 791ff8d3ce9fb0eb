#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "furrow_core/output_path.hpp"
#include "furrow_evaluation/detector_choices.hpp"

namespace furrow::evaluation {

/// Detections in single images, with pictures of them.
struct ImageDetection {
  std::vector<std::filesystem::path> images;
  double resolution_mm_per_px = 1.15;  ///< on the ground
  double min_score = 0.1;              ///< plants below are left out
  std::filesystem::path folder;        ///< of the pictures and of detections.json; exists
  Overwrite overwrite = Overwrite::kNo;
};

struct DetectedImage {
  std::filesystem::path picture;  ///< the image with what was detected drawn over it
  std::size_t plants = 0;
  std::size_t crops = 0;
};

struct ImageDetectionResult {
  std::vector<DetectedImage> images;
  std::vector<std::string> faults;  ///< a sentence for each image that could not be used
  std::filesystem::path json;       ///< COCO, with classes, scores, stems and areas
};

/// Runs one detector on each image. A picture is named after its image; it replaces no image, and
/// no other file unless it is to overwrite. Throws std::runtime_error when a file cannot be
/// written.
[[nodiscard]] ImageDetectionResult detect_images(const NamedDetector& detector,
                                                 const ImageDetection& detection);

/// A file name for a picture in the folder that is none of the `taken` files.
[[nodiscard]] std::filesystem::path picture_path(const std::filesystem::path& folder,
                                                 const std::filesystem::path& image,
                                                 const std::vector<std::filesystem::path>& taken,
                                                 Overwrite overwrite);

}  // namespace furrow::evaluation
