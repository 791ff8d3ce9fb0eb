#include <algorithm>
#include <cmath>
#include <numeric>

#include "furrow_vision/metrics.hpp"

namespace furrow::vision {
namespace {

constexpr std::size_t kMaxDetections = 100;
constexpr int kRecallPoints = 101;
constexpr std::uint8_t kUnmatched = 0, kMatched = 1, kIgnored = 2;

/// IoU, or the share of the detection that lies inside a crowd region.
double overlap_of(const AnnotatedInstance& truth, const Instance& detection, Overlap overlap) {
  if (overlap == Overlap::kBox) {
    if (!truth.crowd) return box_iou(truth.box_px, detection.box_px);
    const double area = detection.box_px.area();
    return area > 0.0 ? (truth.box_px & detection.box_px).area() / area : 0.0;
  }
  const double iou = mask_iou(truth.box_px, truth.mask, detection.box_px, detection.mask);
  if (!truth.crowd || iou == 0.0) return iou;
  // intersection = iou / (1 + iou) * (area of truth + area of detection)
  const double own = cv::countNonZero(detection.mask);
  return iou / (1.0 + iou) * (cv::countNonZero(truth.mask) + own) / own;
}

}  // namespace

void AveragePrecision::add(const std::vector<AnnotatedInstance>& truth,
                           const std::vector<Instance>& detections) {
  for (std::size_t c = 0; c < (mode_ == ClassMode::kAny ? 1u : 2u); ++c) {
    std::vector<const AnnotatedInstance*> truths;
    std::vector<Scored> found;
    for (const AnnotatedInstance& t : truth) {
      const bool crop = t.kind == SubClassKind::kCrop;
      if (mode_ == ClassMode::kAny || crop == (c == 0)) truths.push_back(&t);
    }
    for (const Instance& d : detections) {
      const bool crop = d.crop_probability >= 0.5;
      if (mode_ == ClassMode::kAny) {
        found.push_back({&d, d.score});
      } else if (crop == (c == 0)) {
        found.push_back({&d, d.score * (crop ? d.crop_probability : d.weed_probability())});
      }
    }
    add_class(std::move(truths), std::move(found), classes_[c]);
  }
}

void AveragePrecision::add_class(std::vector<const AnnotatedInstance*> truth,
                                 std::vector<Scored> detections, PerClass& into) const {
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Scored& a, const Scored& b) { return a.score > b.score; });
  if (detections.size() > kMaxDetections) detections.resize(kMaxDetections);
  std::stable_partition(truth.begin(), truth.end(), [](const auto* t) { return !t->crowd; });
  into.truths += std::count_if(truth.begin(), truth.end(), [](const auto* t) { return !t->crowd; });

  std::vector<std::array<bool, kThresholds>> taken(truth.size());
  for (const Scored& detection : detections) {
    std::vector<double> overlaps;
    overlaps.reserve(truth.size());
    for (const auto* t : truth) overlaps.push_back(overlap_of(*t, *detection.instance, overlap_));
    Outcome outcome;
    outcome.score = detection.score;
    for (int k = 0; k < kThresholds; ++k) {
      double best = std::min(0.5 + 0.05 * k, 1.0 - 1e-10);
      std::size_t match = truth.size();
      for (std::size_t t = 0; t < truth.size(); ++t) {
        if (taken[t][k] && !truth[t]->crowd) continue;
        if (match < truth.size() && truth[t]->crowd && !truth[match]->crowd) break;
        if (overlaps[t] < best) continue;
        best = overlaps[t];
        match = t;
      }
      if (match == truth.size()) continue;
      taken[match][k] = true;
      outcome.matched[k] = truth[match]->crowd ? kIgnored : kMatched;
    }
    into.outcomes.push_back(outcome);
  }
}

std::array<double, AveragePrecision::kThresholds> AveragePrecision::class_precisions(
    const PerClass& counts) {
  std::vector<std::size_t> order(counts.outcomes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return counts.outcomes[a].score > counts.outcomes[b].score;
  });
  std::array<double, kThresholds> averages{};
  for (int k = 0; k < kThresholds; ++k) {
    std::vector<double> recall, precision;
    double right = 0.0, wrong = 0.0;
    for (const std::size_t i : order) {
      const std::uint8_t matched = counts.outcomes[i].matched[k];
      if (matched == kIgnored) continue;
      (matched == kMatched ? right : wrong) += 1.0;
      recall.push_back(right / static_cast<double>(counts.truths));
      precision.push_back(right / (right + wrong));
    }
    for (std::size_t i = precision.size(); i > 1; --i) {
      precision[i - 2] = std::max(precision[i - 2], precision[i - 1]);
    }
    double sum = 0.0;
    for (int r = 0; r < kRecallPoints; ++r) {
      const auto at = std::lower_bound(recall.begin(), recall.end(), 0.01 * r);
      if (at != recall.end()) sum += precision[at - recall.begin()];
    }
    averages[k] = sum / kRecallPoints;
  }
  return averages;
}

AveragePrecision::Scores AveragePrecision::scores() const {
  std::array<double, 2> ap50 = {kNaN, kNaN};
  double ap_sum = 0.0, ap50_sum = 0.0;
  int present = 0;
  for (std::size_t c = 0; c < classes_.size(); ++c) {
    if (classes_[c].truths == 0) continue;
    const auto averages = class_precisions(classes_[c]);
    ap50[c] = averages[0];
    ap_sum += std::accumulate(averages.begin(), averages.end(), 0.0) / kThresholds;
    ap50_sum += averages[0];
    ++present;
  }
  const bool split = mode_ == ClassMode::kCropWeed;
  return {.ap = present == 0 ? kNaN : ap_sum / present,
          .ap50 = present == 0 ? kNaN : ap50_sum / present,
          .ap50_crop = split ? ap50[0] : kNaN,
          .ap50_weed = split ? ap50[1] : kNaN};
}

}  // namespace furrow::vision
