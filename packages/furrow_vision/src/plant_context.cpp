#include "furrow_vision/plant_context.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "furrow_vision/row_evidence.hpp"

namespace furrow::vision {
namespace {

struct ColourSum {
  double blue = 0.0, green = 0.0, red = 0.0;

  void add(const cv::Vec3b& pixel) {
    blue += pixel[0];
    green += pixel[1];
    red += pixel[2];
  }
  [[nodiscard]] double total() const { return blue + green + red; }
  [[nodiscard]] RelativeColour coordinates() const {
    const double all = std::max(total(), 1.0);
    return {(green - blue) / all, (green - red) / all};
  }
};

/// Empty sums: no soil that is well exposed.
ColourSum soil_colour(const cv::Mat& bgr, const cv::Mat& vegetation) {
  constexpr int kMargin_px = 3, kStep_px = 2;
  constexpr int kDark = 60, kBright = 720;  // of R + G + B
  cv::Mat near;
  cv::dilate(vegetation, near, cv::Mat::ones(2 * kMargin_px + 1, 2 * kMargin_px + 1, CV_8U));
  ColourSum exposed, any;
  for (int v = 0; v < bgr.rows; v += kStep_px) {
    const auto* pixel = bgr.ptr<cv::Vec3b>(v);
    const auto* plant = near.ptr<std::uint8_t>(v);
    for (int u = 0; u < bgr.cols; u += kStep_px) {
      if (plant[u] != 0) continue;
      const int sum = pixel[u][0] + pixel[u][1] + pixel[u][2];
      any.add(pixel[u]);
      if (sum > kDark && sum < kBright) exposed.add(pixel[u]);
    }
  }
  // In the dark all soil is; its colour is the best that there is.
  return exposed.total() > 0.05 * any.total() ? exposed : any;
}

double logit_of(double probability) {
  constexpr double kLeast = 1e-9;
  const double p = std::clamp(probability, kLeast, 1.0 - kLeast);
  return std::log(p / (1.0 - p));
}

double stem_certainty(const std::vector<Instance>& plants) {
  double sum = 0.0, area = 0.0;
  for (const Instance& plant : plants) {
    sum += plant.area_mm2 * plant.stem_score;
    area += plant.area_mm2;
  }
  return area > 0.0 ? sum / area : 1.0;
}

double familiarity_of(double certainty, const PlantContextParameters& p) {
  if (p.class_evidence == "learned") return 1.0;
  if (p.class_evidence == "context") return 0.0;
  const double span = std::max(p.familiar_to - p.familiar_from, 1e-6);
  return std::clamp((certainty - p.familiar_from) / span, 0.0, 1.0);
}

/// Log-odds of a crop for each plant of an unfamiliar image. `colours` is empty where colour says
/// nothing.
std::vector<double> context_evidence(const RgbdView& view, const PlantContextParameters& p,
                                     const std::vector<RelativeColour>& colours,
                                     const std::vector<Instance>& plants) {
  std::vector<double> evidence(plants.size());
  std::vector<RowPlant> row_plants(plants.size());
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const double learned = logit_of(plants[i].crop_probability);
    evidence[i] = p.look_weight * (learned - p.look_middle);
    if (!colours.empty()) {
      evidence[i] += std::clamp(p.yellowness_weight * (colours[i].yellowness - p.yellowness_middle),
                                -p.yellowness_evidence_max, p.yellowness_evidence_max);
    }
    row_plants[i] = {view.ground_mm_per_px() * plants[i].stem_px, plants[i].area_mm2, evidence[i]};
  }
  const auto row =
      row_evidence(row_plants, {.evidence_max = p.row_evidence_max, .sd_mm = p.row_sd_mm});
  for (std::size_t i = 0; i < plants.size(); ++i) evidence[i] += row[i];
  return evidence;
}

/// Whether a pixel of the plant's mask lies within the reach of a point.
bool reaches(const Instance& plant, const Eigen::Vector2d& at_px, double reach_px) {
  const cv::Rect window = cv::Rect(static_cast<int>(std::floor(at_px.x() - reach_px)),
                                   static_cast<int>(std::floor(at_px.y() - reach_px)),
                                   static_cast<int>(std::ceil(2.0 * reach_px)) + 2,
                                   static_cast<int>(std::ceil(2.0 * reach_px)) + 2) &
                          plant.box_px;
  for (int v = window.y; v < window.y + window.height; ++v) {
    const auto* mask = plant.mask.ptr<std::uint8_t>(v - plant.box_px.y);
    for (int u = window.x; u < window.x + window.width; ++u) {
      if (mask[u - plant.box_px.x] == 0) continue;
      if ((Eigen::Vector2d(u, v) - at_px).norm() <= reach_px) return true;
    }
  }
  return false;
}

/// Adds the mask of `part` to `plant`.
void add_mask(const Instance& part, Instance& plant) {
  const cv::Rect box = plant.box_px | part.box_px;
  cv::Mat mask = cv::Mat::zeros(box.size(), CV_8U);
  mask(plant.box_px - box.tl()).setTo(255, plant.mask);
  mask(part.box_px - box.tl()).setTo(255, part.mask);
  plant.box_px = box;
  plant.mask = mask;
}

std::int64_t merge_into_crops(const RgbdView& view, const PlantContextParameters& p,
                              std::vector<Instance>& plants) {
  const double reach_px = p.crop_reach_mm / view.ground_mm_per_px();
  std::vector<std::size_t> crop_of(plants.size(), plants.size());
  for (std::size_t i = 0; i < plants.size(); ++i) {
    if (plants[i].crop_probability >= 0.5) continue;
    for (std::size_t k = 0; k < plants.size(); ++k) {
      const Instance& crop = plants[k];
      if (crop.crop_probability < 0.5 || crop.area_mm2 < p.crop_reach_area_mm2) continue;
      const bool better =
          crop_of[i] == plants.size() || crop.area_mm2 > plants[crop_of[i]].area_mm2;
      if (better && reaches(crop, plants[i].stem_px, reach_px)) crop_of[i] = k;
    }
  }
  std::vector<bool> grown(plants.size(), false), gone(plants.size(), false);
  std::int64_t merged = 0;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    if (crop_of[i] == plants.size()) continue;
    add_mask(plants[i], plants[crop_of[i]]);
    grown[crop_of[i]] = gone[i] = true;
    ++merged;
  }
  std::vector<Instance> kept;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    if (gone[i]) continue;
    const double stem_depth_m = plants[i].stem_depth_m;
    if (grown[i]) measure_instance(view, plants[i]);
    plants[i].stem_depth_m = stem_depth_m;  // of the ground at the stem, which has not moved
    kept.push_back(std::move(plants[i]));
  }
  plants = std::move(kept);
  return merged;
}

/// Returns how many were dropped.
std::int64_t drop_not_green(const PlantContextParameters& p, bool vegetation_is_rare,
                            std::vector<RelativeColour>& colours, std::vector<Instance>& plants) {
  const std::size_t before = plants.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < before; ++i) {
    const bool stem_seen = plants[i].stem_score >= p.rare_stem_score_min;
    const double least = vegetation_is_rare && !stem_seen ? p.rare_greenness_min : p.greenness_min;
    if (colours[i].greenness < least) continue;
    if (kept != i) {
      plants[kept] = std::move(plants[i]);
      colours[kept] = colours[i];
    }
    ++kept;
  }
  plants.resize(kept);
  colours.resize(kept);
  return static_cast<std::int64_t>(before - kept);
}

void visit_class_evidence(PlantContextParameters& p, ParameterVisitor& v) {
  v.visit({.name = "class_evidence",
           .description = "What tells crops from weeds. learned: the look alone; context: look, "
                          "colour and place; auto: learned in familiar images, else context",
           .choices = {"learned", "context", "auto"}},
          p.class_evidence);
  v.visit({.name = "familiar_from",
           .description = "Mean probability of the stems up to which an image counts as unfamiliar",
           .min = 0.0,
           .max = 1.0},
          p.familiar_from);
  v.visit(
      {.name = "familiar_to",
       .description = "Mean probability of the stems from which on the learned look counts alone",
       .min = 0.0,
       .max = 1.0},
      p.familiar_to);
  v.visit({.name = "look_weight",
           .description = "Of the learned log-odds of a crop in an unfamiliar image",
           .min = 0.0,
           .max = 2.0},
          p.look_weight);
  v.visit(
      {.name = "look_middle",
       .description = "Learned log-odds of a crop that speak for neither in an unfamiliar image",
       .min = -20.0,
       .max = 20.0},
      p.look_middle);
}

void visit_colour(PlantContextParameters& p, ParameterVisitor& v) {
  v.visit({.name = "yellowness_weight",
           .description = "Log-odds of a crop for each unit of (G - B) / (R + G + B), less that of "
                          "the soil; 0: colour does not count",
           .min = -500.0,
           .max = 500.0},
          p.yellowness_weight);
  v.visit({.name = "yellowness_middle",
           .description = "Yellowness between crops and weeds",
           .min = -1.0,
           .max = 1.0},
          p.yellowness_middle);
  v.visit({.name = "yellowness_evidence_max",
           .description = "Bound on the log-odds of the yellowness",
           .min = 0.0,
           .max = 20.0},
          p.yellowness_evidence_max);
}

void visit_row(PlantContextParameters& p, ParameterVisitor& v) {
  v.visit({.name = "row_evidence_max",
           .description = "Log-odds of a crop that the place on or beside the row of an "
                          "unfamiliar image gives; 0: none",
           .min = 0.0,
           .max = 20.0},
          p.row_evidence_max);
  v.visit({.name = "row_sd_mm",
           .unit = "mm",
           .description = "Standard deviation of crops across their row",
           .min = 1.0,
           .max = 1000.0},
          p.row_sd_mm);
}

void visit_removal(PlantContextParameters& p, ParameterVisitor& v) {
  v.visit(
      {.name = "crop_reach_mm",
       .unit = "mm",
       .description = "In an unfamiliar image a weed with its stem this near to a crop's leaves "
                      "is a part of the crop",
       .min = 0.0,
       .max = 200.0},
      p.crop_reach_mm);
  v.visit({.name = "crop_reach_area_mm2",
           .unit = "mm2",
           .description = "Smaller crops have no such reach",
           .min = 0.0,
           .max = 1e6},
          p.crop_reach_area_mm2);
  v.visit({.name = "greenness_min",
           .description = "Least (G - R) / (R + G + B) of a plant, less that of the soil; a plant "
                          "below is taken for stone or straw",
           .min = -1.0,
           .max = 1.0},
          p.greenness_min);
  v.visit({.name = "rare_share",
           .description = "Share of the image up to which vegetation is rare",
           .min = 0.0,
           .max = 1.0},
          p.rare_share);
  v.visit(
      {.name = "rare_greenness_min",
       .description = "As greenness_min, where vegetation is rare and the plant's stem is not seen",
       .min = -1.0,
       .max = 1.0},
      p.rare_greenness_min);
  v.visit({.name = "rare_stem_score_min",
           .description = "Probability from which on a stem counts as seen there",
           .min = 0.0,
           .max = 1.0},
          p.rare_stem_score_min);
}

}  // namespace

void PlantContextParameters::visit(ParameterVisitor& v) {
  visit_class_evidence(*this, v);
  visit_colour(*this, v);
  visit_row(*this, v);
  visit_removal(*this, v);
}

std::vector<RelativeColour> relative_colours(const cv::Mat& bgr, const cv::Mat& vegetation,
                                             const std::vector<Instance>& plants) {
  const ColourSum soil_sum = soil_colour(bgr, vegetation);
  if (soil_sum.total() <= 0.0) return {};
  std::vector<RelativeColour> colours(plants.size());
  const RelativeColour soil = soil_sum.coordinates();
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const cv::Rect& box = plants[i].box_px;
    ColourSum sum;
    for (int v = 0; v < box.height; ++v) {
      const auto* pixel = bgr.ptr<cv::Vec3b>(box.y + v) + box.x;
      const auto* mask = plants[i].mask.ptr<std::uint8_t>(v);
      for (int u = 0; u < box.width; ++u) {
        if (mask[u] != 0) sum.add(pixel[u]);
      }
    }
    const RelativeColour own = sum.coordinates();
    colours[i] = {own.yellowness - soil.yellowness, own.greenness - soil.greenness};
  }
  return colours;
}

ContextReport apply_plant_context(const RgbdView& view, const cv::Mat& vegetation,
                                  ColourKind colour, const std::vector<SubClass>& classes,
                                  const PlantContextParameters& parameters,
                                  std::vector<Instance>& plants) {
  ContextReport report;
  std::vector<RelativeColour> colours = relative_colours(view.bgr, vegetation, plants);
  if (!colours.empty()) {
    const double covered_px = parameters.rare_share * static_cast<double>(vegetation.total());
    const bool rare = cv::countNonZero(vegetation) < covered_px;
    report.dropped_as_not_green = drop_not_green(parameters, rare, colours, plants);
  }
  report.stem_certainty = stem_certainty(plants);
  report.familiarity = familiarity_of(report.stem_certainty, parameters);
  if (report.familiarity >= 1.0) return report;
  if (colour != ColourKind::kNatural) colours.clear();
  const auto evidence = context_evidence(view, parameters, colours, plants);
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const double learned = logit_of(plants[i].crop_probability);
    const double fused = std::lerp(evidence[i], learned, report.familiarity);
    shift_towards_crops(fused - learned, classes, plants[i].class_scores);
    plants[i].crop_probability = crop_probability(plants[i].class_scores, classes);
  }
  constexpr double kMergesBelow = 0.5;
  if (report.familiarity < kMergesBelow) {
    report.merged_into_crops = merge_into_crops(view, parameters, plants);
  }
  return report;
}

}  // namespace furrow::vision
