#include "furrow_vision/evaluation.hpp"

namespace furrow::vision {

double VisionEvaluation::add(const AnnotatedImage& truth, const std::vector<Instance>& detections,
                             const geometry::PinholeCamera& camera) {
  constexpr double kMatchIou = 0.5;
  const cv::Mat labels = semantic_labels(truth);
  const cv::Mat found = semantic_labels(detections, labels.size());
  ++images_;
  semantic_.add(labels, found);
  vegetation_.add_vegetation(truth.vegetation.empty() ? labels : truth.vegetation, found);
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
