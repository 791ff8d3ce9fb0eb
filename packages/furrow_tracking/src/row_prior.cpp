#include "furrow_tracking/row_prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace furrow::tracking {
namespace {

constexpr double kGrid_m = 0.004;
constexpr double kReach_sd = 3.0;
constexpr double kMaxWidth_m = 20.0;
constexpr double kLeastSd_m = 0.005;
// Less than this is not yet a stretch whose densities mean anything.
constexpr double kLeastLength_m = 0.5;

double normal_density(double offset_m, double sd_m) {
  const double z = offset_m / sd_m;
  return std::exp(-0.5 * z * z) / (sd_m * std::sqrt(2.0 * std::numbers::pi));
}

}  // namespace

void RowPriorParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "row_prior",
           .description = "whether the place across the rows tells of the class; rows run along "
                          "the field's x"},
          row_prior);
  v.visit({.name = "row_sd_m",
           .unit = "m",
           .description = "standard deviation of a crop's stem, as seen, across its row: a first "
                          "guess, and the kernel that rows are found with",
           .min = 0.002,
           .max = 0.5},
          row_sd_m);
  v.visit({.name = "row_gap_m",
           .unit = "m",
           .description = "rows do not stand closer than this",
           .min = 0.02,
           .max = 10.0},
          row_gap_m);
  v.visit(
      {.name = "row_min_crops", .description = "crops that make a row", .min = 1.0, .max = 1000.0},
      row_min_crops);
  v.visit({.name = "row_contrast",
           .description = "how much denser crops stand on a row than on the mean of the width",
           .min = 1.0,
           .max = 1000.0},
          row_contrast);
  v.visit({.name = "row_off_share",
           .description = "share of crops that stand anywhere",
           .min = 1e-4,
           .max = 1.0},
          row_off_share);
  v.visit({.name = "row_max_log_odds",
           .description = "bound of what the place may tell",
           .min = 0.0,
           .max = 20.0},
          row_max_log_odds);
}

RowPrior::RowPrior(const RowPriorParameters& parameters) : parameters_(parameters) {
  const auto reach = static_cast<int>(kReach_sd * parameters.row_sd_m / kGrid_m);
  for (int i = 0; i <= reach; ++i) {
    kernel_.push_back(normal_density(i * kGrid_m, parameters.row_sd_m));
  }
}

void RowPrior::smooth_density() {
  const double low_m = samples_.front().y_m;
  const auto cells = static_cast<std::size_t>((samples_.back().y_m - low_m) / kGrid_m) + 1;
  counts_.assign(cells, 0.0);
  density_.assign(cells, 0.0);
  for (const Sample& sample : samples_) {
    counts_[static_cast<std::size_t>((sample.y_m - low_m) / kGrid_m)] += sample.crop;
  }
  for (std::size_t i = 0; i < cells; ++i) {
    if (counts_[i] <= 0.0) continue;
    density_[i] += counts_[i] * kernel_[0];
    for (std::size_t k = 1; k < kernel_.size(); ++k) {
      if (i >= k) density_[i - k] += counts_[i] * kernel_[k];
      if (i + k < cells) density_[i + k] += counts_[i] * kernel_[k];
    }
  }
}

void RowPrior::learn(std::span<const Track> tracks) {
  samples_.clear();
  rows_.clear();
  double first_x_m = INFINITY;
  double last_x_m = -INFINITY;
  for (const Track& track : tracks) {
    if (!track.confirmed || std::abs(track.p_F_m.y()) > 0.5 * kMaxWidth_m) continue;
    samples_.push_back({track.p_F_m.y(), 1.0 / (1.0 + std::exp(-track.class_log_odds))});
    first_x_m = std::min(first_x_m, track.p_F_m.x());
    last_x_m = std::max(last_x_m, track.p_F_m.x());
  }
  const double length_m = last_x_m - first_x_m;
  if (samples_.size() < 2 || length_m < kLeastLength_m) return;
  std::ranges::sort(samples_, {}, &Sample::y_m);
  find_rows(length_m);
  if (!rows_.empty()) count_weeds(length_m);
}

void RowPrior::find_rows(double length_m) {
  smooth_density();
  const double low_m = samples_.front().y_m;
  const auto cells = static_cast<std::ptrdiff_t>(density_.size());
  double crops = 0.0;
  for (const Sample& sample : samples_) crops += sample.crop;
  const double width_m = std::max(samples_.back().y_m - low_m, parameters_.row_gap_m);
  const double least_density = parameters_.row_contrast * crops / width_m;
  // The densest place is a row; what is nearer than the gap belongs to it; and again.
  const auto gap = static_cast<std::ptrdiff_t>(parameters_.row_gap_m / kGrid_m);
  while (true) {
    const auto peak = std::ranges::max_element(density_);
    if (*peak <= 0.0 || *peak < least_density) break;
    const auto at = peak - density_.begin();
    const double peak_y_m = low_m + static_cast<double>(at) * kGrid_m;
    const auto begin = density_.begin() + std::max<std::ptrdiff_t>(at - gap, 0);
    const auto end = density_.begin() + std::min(at + gap + 1, cells);
    std::fill(begin, end, 0.0);
    double weight = 0.0;
    double mean_m = 0.0;
    double square_m2 = 0.0;
    for (const Sample& sample : samples_) {
      const double offset_m = sample.y_m - peak_y_m;
      if (std::abs(offset_m) > kReach_sd * parameters_.row_sd_m) continue;
      weight += sample.crop;
      mean_m += sample.crop * offset_m;
      square_m2 += sample.crop * offset_m * offset_m;
    }
    if (weight < parameters_.row_min_crops) break;
    mean_m /= weight;
    const double variance_m2 = std::max(square_m2 / weight - mean_m * mean_m, 0.0);
    rows_.push_back(
        {peak_y_m + mean_m, std::max(std::sqrt(variance_m2), kLeastSd_m), weight / length_m});
  }
}

void RowPrior::count_weeds(double length_m) {
  const double width_m = samples_.back().y_m - samples_.front().y_m;
  const double row_width_m = 2.0 * kReach_sd * parameters_.row_sd_m;
  const double free_m = std::max(width_m - static_cast<double>(rows_.size()) * row_width_m, 0.1);
  double weeds = 0.0;
  for (const Sample& sample : samples_) {
    const bool on_row = std::ranges::any_of(
        rows_, [&](const Row& row) { return std::abs(sample.y_m - row.y_m) <= 0.5 * row_width_m; });
    if (!on_row) weeds += 1.0 - sample.crop;
  }
  // One more than were seen, so that a clean stretch does not promise that no weed will come.
  weeds_per_m2_ = (weeds + 1.0) / (length_m * free_m);
  double crops_per_m = 0.0;
  for (const Row& row : rows_) crops_per_m += row.crops_per_m;
  crops_off_per_m2_ = parameters_.row_off_share * crops_per_m / std::max(width_m, 0.1);
}

double RowPrior::log_odds(double y_m) const {
  if (rows_.empty()) return 0.0;
  double crops_per_m2 = crops_off_per_m2_;
  for (const Row& row : rows_) {
    crops_per_m2 += row.crops_per_m * normal_density(y_m - row.y_m, row.sd_m);
  }
  const double bound = parameters_.row_max_log_odds;
  return std::clamp(std::log(crops_per_m2 / weeds_per_m2_), -bound, bound);
}

}  // namespace furrow::tracking
