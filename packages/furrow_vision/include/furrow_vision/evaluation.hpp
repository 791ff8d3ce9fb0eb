#pragma once

#include <cstdint>
#include <vector>

#include "furrow_vision/field_outcome.hpp"
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
  FieldOutcome outcome;  ///< what spraying the detections would do
};

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// 95 % intervals by bootstrap over images (Efron 1979, percentiles). NaN where the figure is.
struct ScoreIntervals {
  Interval iou_vegetation;
  Interval iou_crop;
  Interval iou_weed;
  Interval miou;
  Interval crops_sprayed_pct;
  Interval weeds_found_pct;
  Interval false_per_m2;
};

/// Collects them image by image.
class VisionEvaluation {
 public:
  /// Returns the image's own quality, to choose pictures by: the mean IoU of its three classes.
  /// Annotated vegetation without a class (in the vegetation mask, but of no instance) counts as
  /// vegetation and for neither class. Ignored regions count for nothing. Detections that lie in
  /// them by more than half are left out. Areas count where the annotation names them and the plant
  /// is whole. The ground lies at `ground_distance_m`.
  /// @pre the detections are of this image.
  double add(const AnnotatedImage& truth, const std::vector<Instance>& detections,
             const geometry::PinholeCamera& camera, double ground_distance_m = 1.0);
  [[nodiscard]] VisionScores scores() const;
  /// Of the images added so far; the same seed gives the same intervals.
  [[nodiscard]] ScoreIntervals intervals(std::uint64_t seed) const;

 private:
  /// What the figures with an interval need of one image.
  struct ImageCounts {
    SemanticScore semantic;
    SemanticScore vegetation;
    FieldOutcome outcome;
  };

  std::int64_t images_ = 0;
  std::vector<ImageCounts> counts_;
  AveragePrecision ap_mask_{Overlap::kMask, ClassMode::kCropWeed};
  AveragePrecision ap_box_{Overlap::kBox, ClassMode::kCropWeed};
  PanopticQuality pq_{ClassMode::kCropWeed};
  MeasureErrors errors_;
};

}  // namespace furrow::vision
