#include "furrow_vision/index_detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "crop_rows.hpp"
#include "instance_cutting.hpp"
#include "plant_grouping.hpp"

namespace furrow::vision {
namespace {

/// Fewer pixels than this a row spacing, and a row cannot be told.
constexpr double kMinRowSpacing_px = 8.0;

double log_normal(double value, double median, double log_sd) {
  const double z = (std::log(value) - std::log(median)) / log_sd;
  return -0.5 * z * z - std::log(log_sd);
}

}  // namespace

IndexDetector::IndexDetector(const IndexDetectorParameters& parameters)
    : parameters_(parameters),
      classes_{{"crop", SubClassKind::kCrop}, {"weed", SubClassKind::kWeed}} {
  validate_parameters(parameters_);
}

IndexDetector::~IndexDetector() = default;

void IndexDetector::reset() {
  row_profile_.clear();
  crop_row_u_px_.clear();
}

Result<std::vector<Instance>> IndexDetector::detect(const RgbdView& view) {
  if (const Status status = check_view(view); !status) return status.error();
  std::vector<Instance> plants = find_plants(view);
  update_rows(view, plants);
  for (Instance& plant : plants) {
    plant.score = plant.area_mm2 / (plant.area_mm2 + parameters_.min_plant_area_mm2);
    plant.crop_probability = crop_probability_of(plant, view);
    plant.class_scores = {plant.crop_probability, 1.0 - plant.crop_probability};
  }
  return plants;
}

std::vector<Instance> IndexDetector::find_plants(const RgbdView& view) const {
  const IndexDetectorParameters& p = parameters_;
  const double mm_per_px = view.ground_mm_per_px();
  const Vegetation vegetation = segment_vegetation(view.bgr, p.vegetation);
  if (!vegetation.found) return {};
  const int shorter = std::min(view.bgr.cols, view.bgr.rows);
  const int cell = std::clamp(static_cast<int>(std::lround(p.grouping_resolution_mm / mm_per_px)),
                              1, std::max(1, shorter / 16));
  cv::Mat coarse = vegetation.mask;
  if (cell > 1) {
    cv::resize(vegetation.mask, coarse,
               {std::max(1, view.bgr.cols / cell), std::max(1, view.bgr.rows / cell)}, 0, 0,
               cv::INTER_AREA);
    coarse = coarse >= 96;
  }
  const double cell_mm = cell * mm_per_px;
  const PlantGroups groups =
      group_plants(coarse, {.min_area_px = 0.7 * p.min_plant_area_mm2 / (cell_mm * cell_mm),
                            .merge_gap_min_px = p.merge_gap_min_mm / cell_mm,
                            .merge_gap_factor = p.merge_gap_factor,
                            .merge_gap_max_px = p.merge_gap_max_mm / cell_mm,
                            .closing_factor = p.closing_factor,
                            .split_saddle_ratio = p.split_saddle_ratio,
                            .split_min_area_px = p.split_min_area_mm2 / (cell_mm * cell_mm),
                            .stem_kernel_factor = p.stem_kernel_factor,
                            .max_plants = kMaxPlants});
  std::vector<Instance> plants = cut_instances(vegetation.mask, groups.labels,
                                               {1.0 / cell, 1.0 / cell}, groups.stem_px.size());
  for (std::size_t i = 0; i < plants.size(); ++i) {
    // Centres of cells to centres of pixels.
    plants[i].stem_px = groups.stem_px[i] * cell + Eigen::Vector2d::Constant(0.5 * (cell - 1));
  }
  std::erase_if(plants, [](const Instance& plant) { return plant.mask.empty(); });
  for (Instance& plant : plants) {
    measure_instance(view, plant);
    place_stem_on_ground(view, vegetation.mask, plant);
  }
  std::erase_if(plants, [&](const Instance& i) { return i.area_mm2 < p.min_plant_area_mm2; });
  return plants;
}

void IndexDetector::update_rows(const RgbdView& view, const std::vector<Instance>& plants) {
  const IndexDetectorParameters& p = parameters_;
  const double mm_per_px = view.ground_mm_per_px();
  const double spacing_px = 1000.0 * p.row_spacing_m / mm_per_px;
  if (!view.crop_row_u_px.empty()) {
    crop_row_u_px_ = view.crop_row_u_px;
  } else if (spacing_px >= kMinRowSpacing_px) {
    std::vector<RowVote> votes;
    votes.reserve(plants.size());
    for (const Instance& plant : plants) {
      votes.push_back({plant.stem_px.x(), std::min(plant.area_mm2, p.crop_area_mm2)});
    }
    const double sd_px = 1000.0 * p.row_sd_m / mm_per_px;
    add_row_votes(votes, spacing_px, sd_px, p.row_memory, row_profile_);
    crop_row_u_px_ =
        rows_of_profile(row_profile_, spacing_px, view.bgr.cols, 3.0 * sd_px, p.row_contrast_min);
  } else {
    crop_row_u_px_.clear();
  }
}

double IndexDetector::crop_probability_of(const Instance& plant, const RgbdView& view) const {
  const IndexDetectorParameters& p = parameters_;
  double log_odds = std::log(p.crop_share / (1.0 - p.crop_share));
  double size_evidence = log_normal(plant.area_mm2, p.crop_area_mm2, p.crop_area_log_sd) -
                         log_normal(plant.area_mm2, p.weed_area_mm2, p.weed_area_log_sd);
  // Of a plant that is cut off only a part is seen, and above the crop's usual size a plant is not
  // less of a crop.
  if (plant.touches_border) size_evidence = std::max(size_evidence, 0.0);
  log_odds += size_evidence;
  if (!crop_row_u_px_.empty()) {
    double nearest_px = std::abs(plant.stem_px.x() - crop_row_u_px_.front());
    for (const double u : crop_row_u_px_) {
      nearest_px = std::min(nearest_px, std::abs(plant.stem_px.x() - u));
    }
    const double off_m =
        nearest_px * view.ground_distance_m / view.camera.intrinsics().fx_px / p.row_sd_m;
    constexpr double kOffRow = 0.02;  // share of crops that stand anywhere
    const double density_on_row =
        std::exp(-0.5 * off_m * off_m) / (p.row_sd_m * std::sqrt(2.0 * std::numbers::pi));
    const double density_anywhere = 1.0 / p.row_spacing_m;
    log_odds += std::log((1.0 - kOffRow) * density_on_row / density_anywhere + kOffRow);
  }
  return 1.0 / (1.0 + std::exp(-log_odds));
}

void IndexDetectorParameters::visit(ParameterVisitor& v) {
  vegetation.visit(v);
  visit_grouping(v);
  visit_rows(v);
  visit_classes(v);
}

void IndexDetectorParameters::visit_grouping(ParameterVisitor& v) {
  v.visit({.name = "grouping_resolution_mm",
           .unit = "mm",
           .description = "Cell at which pieces are put together into plants",
           .min = 0.1,
           .max = 20.0},
          grouping_resolution_mm);
  v.visit({.name = "min_plant_area_mm2",
           .unit = "mm2",
           .description = "Smaller ones are taken for specks",
           .min = 0.1,
           .max = 1e5},
          min_plant_area_mm2);
  v.visit({.name = "merge_gap_min_mm",
           .unit = "mm",
           .description = "Pieces of any size with a gap below this are one plant",
           .min = 0.0,
           .max = 500.0},
          merge_gap_min_mm);
  v.visit({.name = "merge_gap_factor",
           .description = "Added to that gap, as a share of the root of the smaller one's area",
           .min = 0.0,
           .max = 5.0},
          merge_gap_factor);
  v.visit({.name = "merge_gap_max_mm",
           .unit = "mm",
           .description = "Pieces farther apart than this are never one plant",
           .min = 0.0,
           .max = 500.0},
          merge_gap_max_mm);
  v.visit({.name = "closing_factor",
           .description = "Deviation of the Gauss filter that closes a canopy before its thickest "
                          "places are sought, over the root of its area",
           .min = 0.0,
           .max = 1.0},
          closing_factor);
  v.visit({.name = "split_saddle_ratio",
           .description = "Two thick places with a saddle below this share of the thinner one are "
                          "two plants",
           .min = 0.0,
           .max = 1.0},
          split_saddle_ratio);
  v.visit({.name = "split_min_area_mm2",
           .unit = "mm2",
           .description = "A smaller part is a leaf, not a plant of its own",
           .min = 0.0,
           .max = 1e6},
          split_min_area_mm2);
  v.visit({.name = "stem_kernel_factor",
           .description = "Deviation of the kernel that seeks the stem as the canopy's densest "
                          "place, over the root of its area",
           .min = 0.1,
           .max = 100.0},
          stem_kernel_factor);
}

void IndexDetectorParameters::visit_rows(ParameterVisitor& v) {
  v.visit({.name = "row_spacing_m",
           .unit = "m",
           .description = "Distance of the crop rows",
           .min = 0.02,
           .max = 10.0},
          row_spacing_m);
  v.visit({.name = "row_sd_m",
           .unit = "m",
           .description = "Standard deviation of a crop's stem, as seen, across its row",
           .min = 0.001,
           .max = 1.0},
          row_sd_m);
  v.visit({.name = "row_memory",
           .description = "Share of the earlier frames in the estimate of the rows",
           .min = 0.0,
           .max = 0.999},
          row_memory);
  v.visit({.name = "row_contrast_min",
           .description = "Rows count when their evidence is this often the mean one",
           .min = 1.0,
           .max = 100.0},
          row_contrast_min);
}

void IndexDetectorParameters::visit_classes(ParameterVisitor& v) {
  v.visit({.name = "crop_share",
           .description = "Share of crops among the plants, before anything is seen",
           .min = 0.001,
           .max = 0.999},
          crop_share);
  v.visit({.name = "crop_area_mm2",
           .unit = "mm2",
           .description = "Median leaf area of a crop",
           .min = 1.0,
           .max = 1e6},
          crop_area_mm2);
  v.visit({.name = "crop_area_log_sd",
           .description = "Spread of the logarithm of a crop's area",
           .min = 0.05,
           .max = 5.0},
          crop_area_log_sd);
  v.visit({.name = "weed_area_mm2",
           .unit = "mm2",
           .description = "Median leaf area of a weed",
           .min = 1.0,
           .max = 1e6},
          weed_area_mm2);
  v.visit({.name = "weed_area_log_sd",
           .description = "Spread of the logarithm of a weed's area",
           .min = 0.05,
           .max = 5.0},
          weed_area_log_sd);
}

}  // namespace furrow::vision
