#include "furrow_vision/evaluation.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "furrow_core/random.hpp"
#include "furrow_core/statistics.hpp"

namespace furrow::vision {
namespace {

/// Annotated vegetation that no instance covers.
cv::Mat vegetation_without_class(const AnnotatedImage& truth, const cv::Mat& labels) {
  if (truth.vegetation.empty()) return cv::Mat::zeros(labels.size(), CV_8U);
  return (truth.vegetation > 0) & (labels == 0);
}

/// Those that lie in an ignored region by less than half.
std::vector<Instance> counted_detections(const std::vector<Instance>& detections,
                                         const cv::Mat& ignored) {
  std::vector<Instance> counted;
  for (const Instance& detection : detections) {
    const int inside = cv::countNonZero(ignored(detection.box_px) & detection.mask);
    if (2 * inside <= cv::countNonZero(detection.mask)) counted.push_back(detection);
  }
  return counted;
}

/// Areas of the plants that are not cut off; 0: not to be judged.
std::vector<double> true_areas_mm2(const AnnotatedImage& truth, cv::Size size) {
  std::vector<double> areas;
  for (const AnnotatedInstance& instance : truth.instances) {
    const cv::Rect& box = instance.box_px;
    const bool whole = !instance.truncated && box.x > 0 && box.y > 0 && box.br().x < size.width &&
                       box.br().y < size.height;
    areas.push_back(whole ? instance.area_mm2.value_or(0.0) : 0.0);
  }
  return areas;
}

Interval percentiles(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  constexpr double kTail = 0.025;
  return {quantile(values, kTail), quantile(values, 1.0 - kTail)};
}

}  // namespace

double VisionEvaluation::add(const AnnotatedImage& truth, const std::vector<Instance>& detections,
                             const geometry::PinholeCamera& camera, double ground_distance_m) {
  constexpr double kMatchIou = 0.5;
  cv::Mat labels = semantic_labels(truth);
  cv::Mat vegetation = truth.vegetation.empty() ? labels > 0 : truth.vegetation > 0;
  const cv::Mat ignored = ignored_region(truth);
  const std::vector<Instance> counted = counted_detections(detections, ignored);
  cv::Mat found = semantic_labels(detections, labels.size());
  for (cv::Mat* mask : {&labels, &vegetation, &found}) mask->setTo(0, ignored);

  ImageCounts counts;
  counts.vegetation.add_vegetation(vegetation, found);
  found.setTo(0, vegetation_without_class(truth, labels));
  counts.semantic.add(labels, found);
  const double mm_per_px = 1000.0 * ground_distance_m / camera.intrinsics().fx_px;
  counts.outcome = field_outcome(truth, counted, mm_per_px);
  ap_mask_.add(truth.instances, counted);
  ap_box_.add(truth.instances, counted);
  pq_.add(truth.instances, counted);
  std::vector<AnnotatedInstance> measured = truth.instances;
  for (AnnotatedInstance& instance : measured) {
    if (instance.truncated) instance.stem_px.reset();
  }
  add_measure_errors(measured, true_areas_mm2(truth, labels.size()), counted, camera, kMatchIou,
                     errors_);
  const double quality = counts.semantic.mean_iou();
  counts_.push_back(std::move(counts));
  return quality;
}

VisionScores VisionEvaluation::scores() const {
  const auto mask = ap_mask_.scores();
  constexpr double kPercent = 100.0;
  ImageCounts sum;
  for (const ImageCounts& counts : counts_) {
    sum.semantic += counts.semantic;
    sum.vegetation += counts.vegetation;
    sum.outcome += counts.outcome;
  }
  return {.images = static_cast<std::int64_t>(counts_.size()),
          .iou_vegetation = sum.vegetation.vegetation().iou(),
          .iou_crop = sum.semantic.crop().iou(),
          .iou_weed = sum.semantic.weed().iou(),
          .miou = sum.semantic.mean_iou(),
          .ap_mask = mask.ap,
          .ap50_mask = mask.ap50,
          .ap50_box = ap_box_.scores().ap50,
          .ap50_crop = mask.ap50_crop,
          .ap50_weed = mask.ap50_weed,
          .pq = pq_.value(),
          .stem_p50_mm = quantile(errors_.stem_mm, 0.5),
          .area_error_p50_pct = kPercent * quantile(errors_.area_relative, 0.5),
          .outcome = std::move(sum.outcome)};
}

ScoreIntervals VisionEvaluation::intervals(std::uint64_t seed) const {
  constexpr int kResamples = 1000;
  constexpr std::size_t kFigures = 7;
  if (counts_.empty()) {
    constexpr Interval kNone{kNaN, kNaN};
    return {kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  }
  std::array<std::vector<double>, kFigures> values;
  Random random(seed, "bootstrap over images");
  const auto last = static_cast<std::int64_t>(counts_.size()) - 1;
  for (int i = 0; i < kResamples; ++i) {
    SemanticScore semantic, vegetation;
    FieldOutcome outcome;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      const ImageCounts& counts = counts_[static_cast<std::size_t>(random.integer(0, last))];
      semantic += counts.semantic;
      vegetation += counts.vegetation;
      outcome += counts.outcome;
    }
    const std::array figures = {vegetation.vegetation().iou(), semantic.crop().iou(),
                                semantic.weed().iou(),         semantic.mean_iou(),
                                outcome.crops_sprayed_pct(),   outcome.weeds_found_pct(),
                                outcome.false_per_m2()};
    for (std::size_t k = 0; k < kFigures; ++k) values[k].push_back(figures[k]);
  }
  return {percentiles(values[0]), percentiles(values[1]), percentiles(values[2]),
          percentiles(values[3]), percentiles(values[4]), percentiles(values[5]),
          percentiles(values[6])};
}

}  // namespace furrow::vision
