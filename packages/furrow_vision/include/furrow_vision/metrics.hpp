#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::vision {

/// A figure that the data set does not give.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Intersection and union of pixels, summed over images (not a mean of the images' ratios).
struct IouCount {
  std::int64_t intersection = 0;
  std::int64_t united = 0;
  /// 1 when neither has a pixel.
  [[nodiscard]] double iou() const;
};

/// Semantic IoU of soil, weed and crop (labels 0, 1, 2) and of vegetation (any label but 0).
class SemanticScore {
 public:
  /// @pre both CV_8U, of one size, with labels 0..2.
  void add(const cv::Mat& truth, const cv::Mat& predicted);
  /// Vegetation alone: masks, zero or not.
  void add_vegetation(const cv::Mat& truth, const cv::Mat& predicted);
  SemanticScore& operator+=(const SemanticScore& other);
  [[nodiscard]] const IouCount& soil() const { return label_[0]; }
  [[nodiscard]] const IouCount& weed() const { return label_[1]; }
  [[nodiscard]] const IouCount& crop() const { return label_[2]; }
  [[nodiscard]] const IouCount& vegetation() const { return vegetation_; }
  /// Mean over soil, weed and crop.
  [[nodiscard]] double mean_iou() const;

 private:
  std::array<IouCount, 3> label_{};
  IouCount vegetation_{};
};

/// Labels as semantic_labels() gives them, of what a detector found.
[[nodiscard]] cv::Mat semantic_labels(const std::vector<Instance>& instances, cv::Size size);

[[nodiscard]] double box_iou(const cv::Rect& a, const cv::Rect& b);
/// Of masks over boxes.
[[nodiscard]] double mask_iou(const cv::Rect& box_a, const cv::Mat& mask_a, const cv::Rect& box_b,
                              const cv::Mat& mask_b);

enum class Overlap { kBox, kMask };
enum class ClassMode {
  kAny,  ///< plant or not
  kCropWeed,
};

/// Average precision by COCO's procedure (Lin et al. 2014; cocoeval). At each IoU threshold .50 to
/// .95 detections in the order of their score match the free annotation of greatest IoU. Precision
/// is made monotone and read at recall 0, .01, ..., 1. All areas count, and 100 detections an image
/// and class. Crowd regions neither count nor punish. Classes without an annotation do not count in
/// the mean.
class AveragePrecision {
 public:
  AveragePrecision(Overlap overlap, ClassMode mode) : overlap_(overlap), mode_(mode) {}
  void add(const std::vector<AnnotatedInstance>& truth, const std::vector<Instance>& detections);
  struct Scores {
    double ap = 0.0;  ///< mean over thresholds .50:.05:.95 and classes; NaN without a truth
    double ap50 = 0.0;
    double ap50_crop = 0.0;  ///< NaN without a crop, and with ClassMode::kAny
    double ap50_weed = 0.0;
  };
  [[nodiscard]] Scores scores() const;

 private:
  static constexpr int kThresholds = 10;
  struct Outcome {
    double score = 0.0;
    std::array<std::uint8_t, kThresholds> matched{};  ///< 0 no, 1 yes, 2 ignored
  };
  struct PerClass {
    std::vector<Outcome> outcomes;
    std::int64_t truths = 0;
  };
  struct Scored {
    const Instance* instance;
    double score;
  };
  void add_class(std::vector<const AnnotatedInstance*> truth, std::vector<Scored> detections,
                 PerClass& into) const;
  static std::array<double, kThresholds> class_precisions(const PerClass& counts);

  Overlap overlap_;
  ClassMode mode_;
  std::array<PerClass, 2> classes_{};
};

/// Panoptic quality over instances (Kirillov et al. 2019): sum of the matched IoU (above .5, masks)
/// over TP + FP/2 + FN/2; a match needs the same class under kCropWeed; mean over the classes.
class PanopticQuality {
 public:
  explicit PanopticQuality(ClassMode mode) : mode_(mode) {}
  void add(const std::vector<AnnotatedInstance>& truth, const std::vector<Instance>& detections);
  /// NaN when neither truth nor detections were added.
  [[nodiscard]] double value() const;

 private:
  struct Count {
    double iou_sum = 0.0;
    std::int64_t tp = 0, fp = 0, fn = 0;
  };
  ClassMode mode_;
  std::array<Count, 2> counts_{};
};

/// Truth and detection that belong together: greatest mask IoU first, one to one, IoU >= min_iou.
struct MatchedPair {
  std::size_t truth = 0;
  std::size_t detection = 0;
  double iou = 0.0;
};
[[nodiscard]] std::vector<MatchedPair> match_instances(const std::vector<AnnotatedInstance>& truth,
                                                       const std::vector<Instance>& detections,
                                                       double min_iou);

/// Errors of the matched pairs, kept whole for quantiles.
struct MeasureErrors {
  std::vector<double> stem_mm;        ///< truths with a stem only
  std::vector<double> area_relative;  ///< |found - true| / true
};
/// Errors of stems (at the detection's depth) and areas of one image. `true_area_mm2` runs along
/// `truth`; entries that are not positive are left out. @pre sizes agree, or it is empty.
void add_measure_errors(const std::vector<AnnotatedInstance>& truth,
                        const std::vector<double>& true_area_mm2,
                        const std::vector<Instance>& detections,
                        const geometry::PinholeCamera& camera, double min_iou, MeasureErrors& into);

}  // namespace furrow::vision
