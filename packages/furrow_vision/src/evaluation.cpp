#include "furrow_vision/evaluation.hpp"

#include "furrow_core/statistics.hpp"

namespace furrow::vision {
namespace {

/// Crowd regions, and vegetation that no instance covers.
cv::Mat vegetation_without_class(const AnnotatedImage& truth) {
  AnnotatedImage crowds = truth, plants = truth;
  std::erase_if(crowds.instances, [](const auto& instance) { return !instance.crowd; });
  std::erase_if(plants.instances, [](const auto& instance) { return instance.crowd; });
  cv::Mat without = semantic_labels(crowds) > 0;
  if (!truth.vegetation.empty()) without |= truth.vegetation > 0;
  without.setTo(0, semantic_labels(plants) > 0);
  return without;
}

}  // namespace

double VisionEvaluation::add(const AnnotatedImage& truth, const std::vector<Instance>& detections,
                             const geometry::PinholeCamera& camera) {
  constexpr double kMatchIou = 0.5;
  const cv::Mat all = semantic_labels(truth);
  cv::Mat found = semantic_labels(detections, all.size());
  ++images_;
  vegetation_.add_vegetation(truth.vegetation.empty() ? all : truth.vegetation, found);
  cv::Mat labels = all.clone();
  const cv::Mat without_class = vegetation_without_class(truth);
  labels.setTo(0, without_class);
  found.setTo(0, without_class);
  semantic_.add(labels, found);
  ap_mask_.add(truth.instances, detections);
  ap_box_.add(truth.instances, detections);
  pq_.add(truth.instances, detections);
  std::vector<double> true_area_mm2;
  for (const AnnotatedInstance& instance : truth.instances) {
    const cv::Rect& box = instance.box_px;
    const bool whole =
        box.x > 0 && box.y > 0 && box.br().x < labels.cols && box.br().y < labels.rows;
    true_area_mm2.push_back(whole ? instance.area_mm2.value_or(0.0) : 0.0);
  }
  add_measure_errors(truth.instances, true_area_mm2, detections, camera, kMatchIou, errors_);
  SemanticScore own;
  own.add(labels, found);
  return own.mean_iou();
}

VisionScores VisionEvaluation::scores() const {
  const auto mask = ap_mask_.scores();
  constexpr double kPercent = 100.0;
  return {.images = images_,
          .iou_vegetation = vegetation_.vegetation().iou(),
          .iou_crop = semantic_.crop().iou(),
          .iou_weed = semantic_.weed().iou(),
          .miou = semantic_.mean_iou(),
          .ap_mask = mask.ap,
          .ap50_mask = mask.ap50,
          .ap50_box = ap_box_.scores().ap50,
          .ap50_crop = mask.ap50_crop,
          .ap50_weed = mask.ap50_weed,
          .pq = pq_.value(),
          .stem_p50_mm = quantile(errors_.stem_mm, 0.5),
          .area_error_p50_pct = kPercent * quantile(errors_.area_relative, 0.5)};
}

}  // namespace furrow::vision
