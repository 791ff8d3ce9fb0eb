#pragma once

#include <string>
#include <vector>

#include "furrow_annotation/dataset.hpp"
#include "furrow_evaluation/vision_report.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::evaluation {

/// Keeps the pictures of the best and of the worst images of one detector on one data set, as the
/// images go by.
class VisionGallery {
 public:
  /// Whether a picture of this quality would be kept.
  [[nodiscard]] bool wants(double miou) const;
  void add(VisionPicture picture);
  /// Appends the pictures, each once, best first.
  void move_to(std::vector<VisionPicture>& pictures);

 private:
  std::vector<VisionPicture> best_;
  std::vector<VisionPicture> worst_;
};

/// JPEG of the image twice: with the annotations on the left, with the detections on the right.
/// Throws std::runtime_error when it cannot be encoded.
[[nodiscard]] std::string side_by_side_jpeg(const annotation::AnnotatedImage& image,
                                            const std::vector<vision::Instance>& found,
                                            const std::vector<annotation::SubClass>& classes);

}  // namespace furrow::evaluation
