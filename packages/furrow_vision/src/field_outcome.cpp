#include "furrow_vision/field_outcome.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "furrow_vision/metrics.hpp"

namespace furrow::vision {
namespace {

bool holds_point(const AnnotatedInstance& plant, const Eigen::Vector2d& p_px) {
  const cv::Point at(static_cast<int>(std::lround(p_px.x())),
                     static_cast<int>(std::lround(p_px.y())));
  return plant.box_px.contains(at) &&
         plant.mask.at<std::uint8_t>(at.y - plant.box_px.y, at.x - plant.box_px.x) != 0;
}

Eigen::Vector2d middle_of(const AnnotatedInstance& plant) {
  const cv::Moments moments = cv::moments(plant.mask, true);
  return {plant.box_px.x + moments.m10 / moments.m00, plant.box_px.y + moments.m01 / moments.m00};
}

bool is_cut_off(const AnnotatedInstance& plant, const AnnotatedImage& image) {
  const cv::Rect& box = plant.box_px;
  return plant.truncated || box.x == 0 || box.y == 0 || box.br().x >= image.width_px ||
         box.br().y >= image.height_px;
}

double nearest_mm(const std::vector<Eigen::Vector2d>& stems_px, const Eigen::Vector2d& at_px,
                  double mm_per_px) {
  double nearest_px = std::numeric_limits<double>::infinity();
  for (const auto& stem : stems_px) nearest_px = std::min(nearest_px, (stem - at_px).norm());
  return nearest_px * mm_per_px;
}

bool is_sprayed(const AnnotatedInstance& crop, const std::vector<Eigen::Vector2d>& sprayed_px,
                double mm_per_px, const SprayRule& rule) {
  if (crop.stem_px &&
      nearest_mm(sprayed_px, *crop.stem_px, mm_per_px) <= rule.footprint_radius_mm) {
    return true;
  }
  return std::any_of(sprayed_px.begin(), sprayed_px.end(),
                     [&](const Eigen::Vector2d& stem) { return holds_point(crop, stem); });
}

bool overlaps(const cv::Mat& region, const Instance& detection) {
  return cv::countNonZero(region(detection.box_px) & detection.mask) > 0;
}

double share_pct(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? kNaN : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

FieldOutcome& FieldOutcome::operator+=(const FieldOutcome& other) {
  crops += other.crops;
  crops_sprayed += other.crops_sprayed;
  weeds += other.weeds;
  weeds_found += other.weeds_found;
  detections_on_nothing += other.detections_on_nothing;
  area_m2 += other.area_m2;
  stem_error_mm.insert(stem_error_mm.end(), other.stem_error_mm.begin(), other.stem_error_mm.end());
  return *this;
}

double FieldOutcome::crops_sprayed_pct() const {
  return share_pct(crops_sprayed, crops);
}
double FieldOutcome::weeds_found_pct() const {
  return share_pct(weeds_found, weeds);
}
double FieldOutcome::false_per_m2() const {
  return area_m2 > 0.0 ? static_cast<double>(detections_on_nothing) / area_m2 : kNaN;
}

cv::Mat ignored_region(const AnnotatedImage& truth) {
  constexpr int kMargin_px = 2;  // the annotator's outline of such a region is rough
  constexpr int kSide_px = 2 * kMargin_px + 1;
  cv::Mat region = cv::Mat::zeros(truth.height_px, truth.width_px, CV_8U);
  for (const AnnotatedInstance& instance : truth.instances) {
    if (instance.crowd) region(instance.box_px).setTo(255, instance.mask);
  }
  cv::dilate(region, region, cv::Mat::ones(kSide_px, kSide_px, CV_8U));
  const cv::Rect image(0, 0, truth.width_px, truth.height_px);
  for (const cv::Rect& box : truth.ignore_boxes) region(box & image).setTo(255);
  for (const AnnotatedInstance& instance : truth.instances) {
    if (!instance.crowd) region(instance.box_px).setTo(0, instance.mask);
  }
  return region;
}

FieldOutcome field_outcome(const AnnotatedImage& truth, const std::vector<Instance>& detections,
                           double mm_per_px, const SprayRule& rule) {
  FieldOutcome outcome;
  const cv::Mat ignored = ignored_region(truth);
  cv::Mat plants = semantic_labels(truth) > 0;
  if (!truth.vegetation.empty()) plants |= truth.vegetation > 0;
  std::vector<Eigen::Vector2d> sprayed_px;
  for (const Instance& detection : detections) {
    if (detection.weed_probability() >= rule.weed_probability_min) {
      sprayed_px.push_back(detection.stem_px);
    }
    if (!overlaps(plants, detection) && !overlaps(ignored, detection)) {
      ++outcome.detections_on_nothing;
    }
  }
  for (const AnnotatedInstance& plant : truth.instances) {
    if (plant.crowd) continue;
    if (plant.kind == SubClassKind::kCrop) {
      ++outcome.crops;
      if (is_sprayed(plant, sprayed_px, mm_per_px, rule)) ++outcome.crops_sprayed;
    } else if (!is_cut_off(plant, truth)) {
      ++outcome.weeds;
      const double off_mm =
          nearest_mm(sprayed_px, plant.stem_px.value_or(middle_of(plant)), mm_per_px);
      if (off_mm > rule.found_within_mm) continue;
      ++outcome.weeds_found;
      if (plant.stem_px) outcome.stem_error_mm.push_back(off_mm);
    }
  }
  const double counted_px = static_cast<double>(ignored.total()) - cv::countNonZero(ignored);
  outcome.area_m2 = counted_px * mm_per_px * mm_per_px * 1e-6;
  return outcome;
}

}  // namespace furrow::vision
