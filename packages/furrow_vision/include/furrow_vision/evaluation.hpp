#pragma once

#include <cstdint>
#include <vector>

#include "furrow_vision/metrics.hpp"

namespace furrow::vision {

/// The figures of one detector on one data set. NaN: the data set does not say (stems, areas).
struct VisionScores {
  std::int64_t images = 0;
  double iou_vegetation = 0.0;
  double iou_crop = 0.0;
  double iou_weed = 0.0;
  double miou = 0.0;  ///< mean over soil, weed and crop
  double ap_mask = 0.0;
  double ap50_mask = 0.0;  ///< as the next one, mean over crop and weed
  double ap50_box = 0.0;
  double ap50_crop = 0.0;  ///< masks
  double ap50_weed = 0.0;
  double pq = 0.0;
  double stem_p50_mm = 0.0;
  double area_error_p50_pct = 0.0;
};

/// Collects them image by image.
class VisionEvaluation {
 public:
  /// Returns the image's own quality, to choose pictures by: the mean IoU of its three classes.
  /// Vegetation that the truth gives no class (crowd regions, and what no instance covers) counts
  /// as vegetation and for neither class. Areas count where the truth names them and the plant is
  /// not cut off by the image's border.
  /// @pre the detections are of this image.
  double add(const AnnotatedImage& truth, const std::vector<Instance>& detections,
             const geometry::PinholeCamera& camera);
  [[nodiscard]] VisionScores scores() const;

 private:
  std::int64_t images_ = 0;
  SemanticScore semantic_;
  SemanticScore vegetation_;
  AveragePrecision ap_mask_{Overlap::kMask, ClassMode::kCropWeed};
  AveragePrecision ap_box_{Overlap::kBox, ClassMode::kCropWeed};
  PanopticQuality pq_{ClassMode::kCropWeed};
  MeasureErrors errors_;
};

}  // namespace furrow::vision
