#include "furrow_vision/metrics.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::vision {
namespace {

int mask_intersection(const cv::Rect& box_a, const cv::Mat& mask_a, const cv::Rect& box_b,
                      const cv::Mat& mask_b) {
  const cv::Rect common = box_a & box_b;
  if (common.empty()) return 0;
  return cv::countNonZero(mask_a(common - box_a.tl()) & mask_b(common - box_b.tl()));
}

}  // namespace

double IouCount::iou() const {
  return united == 0 ? 1.0 : static_cast<double>(intersection) / static_cast<double>(united);
}

void SemanticScore::add(const cv::Mat& truth, const cv::Mat& predicted) {
  for (int label = 0; label < 3; ++label) {
    const cv::Mat a = truth == label, b = predicted == label;
    label_[label].intersection += cv::countNonZero(a & b);
    label_[label].united += cv::countNonZero(a | b);
  }
}

void SemanticScore::add_vegetation(const cv::Mat& truth, const cv::Mat& predicted) {
  const cv::Mat a = truth > 0, b = predicted > 0;
  vegetation_.intersection += cv::countNonZero(a & b);
  vegetation_.united += cv::countNonZero(a | b);
}

SemanticScore& SemanticScore::operator+=(const SemanticScore& other) {
  const auto add = [](IouCount& to, const IouCount& from) {
    to.intersection += from.intersection;
    to.united += from.united;
  };
  for (std::size_t i = 0; i < label_.size(); ++i) add(label_[i], other.label_[i]);
  add(vegetation_, other.vegetation_);
  return *this;
}

double SemanticScore::mean_iou() const {
  return (label_[0].iou() + label_[1].iou() + label_[2].iou()) / 3.0;
}

cv::Mat semantic_labels(const std::vector<Instance>& instances, cv::Size size) {
  cv::Mat labels = cv::Mat::zeros(size, CV_8U);
  for (const Instance& instance : instances) {
    labels(instance.box_px).setTo(instance.crop_probability >= 0.5 ? 2 : 1, instance.mask);
  }
  return labels;
}

double box_iou(const cv::Rect& a, const cv::Rect& b) {
  const double common = (a & b).area();
  const double united = static_cast<double>(a.area()) + b.area() - common;
  return united > 0.0 ? common / united : 0.0;
}

double mask_iou(const cv::Rect& box_a, const cv::Mat& mask_a, const cv::Rect& box_b,
                const cv::Mat& mask_b) {
  const int common = mask_intersection(box_a, mask_a, box_b, mask_b);
  if (common == 0) return 0.0;
  return static_cast<double>(common) /
         (cv::countNonZero(mask_a) + cv::countNonZero(mask_b) - common);
}

std::vector<MatchedPair> match_instances(const std::vector<AnnotatedInstance>& truth,
                                         const std::vector<Instance>& detections, double min_iou) {
  std::vector<MatchedPair> candidates;
  for (std::size_t t = 0; t < truth.size(); ++t) {
    for (std::size_t d = 0; d < detections.size(); ++d) {
      const double iou =
          mask_iou(truth[t].box_px, truth[t].mask, detections[d].box_px, detections[d].mask);
      if (iou > 0.0 && iou >= min_iou) candidates.push_back({t, d, iou});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.iou > b.iou; });
  std::vector<bool> truth_taken(truth.size()), detection_taken(detections.size());
  std::vector<MatchedPair> pairs;
  for (const MatchedPair& pair : candidates) {
    if (truth_taken[pair.truth] || detection_taken[pair.detection]) continue;
    truth_taken[pair.truth] = detection_taken[pair.detection] = true;
    pairs.push_back(pair);
  }
  return pairs;
}

void PanopticQuality::add(const std::vector<AnnotatedInstance>& truth,
                          const std::vector<Instance>& detections) {
  for (std::size_t c = 0; c < (mode_ == ClassMode::kAny ? 1u : 2u); ++c) {
    std::vector<AnnotatedInstance> truths;
    std::vector<Instance> found;
    for (const auto& t : truth) {
      const bool crop = t.kind == SubClassKind::kCrop;
      if (!t.crowd && (mode_ == ClassMode::kAny || crop == (c == 0))) truths.push_back(t);
    }
    for (const auto& d : detections) {
      const bool crop = d.crop_probability >= 0.5;
      if (mode_ == ClassMode::kAny || crop == (c == 0)) found.push_back(d);
    }
    auto pairs = match_instances(truths, found, 0.5);
    std::erase_if(pairs, [](const MatchedPair& pair) { return pair.iou <= 0.5; });
    for (const MatchedPair& pair : pairs) counts_[c].iou_sum += pair.iou;
    const auto matched = static_cast<std::int64_t>(pairs.size());
    counts_[c].tp += matched;
    counts_[c].fp += static_cast<std::int64_t>(found.size()) - matched;
    counts_[c].fn += static_cast<std::int64_t>(truths.size()) - matched;
  }
}

double PanopticQuality::value() const {
  double sum = 0.0;
  int classes = 0;
  for (const Count& count : counts_) {
    const double all = static_cast<double>(count.tp) + 0.5 * static_cast<double>(count.fp) +
                       0.5 * static_cast<double>(count.fn);
    if (all == 0.0) continue;
    sum += count.iou_sum / all;
    ++classes;
  }
  return classes == 0 ? kNaN : sum / classes;
}

void add_measure_errors(const std::vector<AnnotatedInstance>& truth,
                        const std::vector<double>& true_area_mm2,
                        const std::vector<Instance>& detections,
                        const geometry::PinholeCamera& camera, double min_iou,
                        MeasureErrors& into) {
  for (const MatchedPair& pair : match_instances(truth, detections, min_iou)) {
    const AnnotatedInstance& t = truth[pair.truth];
    const Instance& d = detections[pair.detection];
    if (t.stem_px && d.stem_depth_m > 0.0) {
      const Eigen::Vector3d off = camera.unproject(*t.stem_px, d.stem_depth_m) -
                                  camera.unproject(d.stem_px, d.stem_depth_m);
      into.stem_mm.push_back(1000.0 * off.norm());
    }
    if (!true_area_mm2.empty() && true_area_mm2[pair.truth] > 0.0) {
      into.area_relative.push_back(std::abs(d.area_mm2 / true_area_mm2[pair.truth] - 1.0));
    }
  }
}

}  // namespace furrow::vision
