#include "species_fusion.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::tracking {
namespace {

void update_probability(Track& track, const TrackerParameters& parameters) {
  const std::vector<float>& sums = track.species_log_odds;
  track.species_probability.assign(sums.size(), 0.0F);
  const double discount =
      1.0 / (1.0 + std::max(track.species_views - 1.0, 0.0) * parameters.species_view_correlation);
  // Weights relative to the largest, so that no exponential overflows.
  const double largest = *std::max_element(sums.begin(), sums.end()) * discount;
  double total = 0.0;
  std::int64_t named = 0;
  for (const float sum : sums) {
    if (sum <= 0.0F) continue;
    ++named;
    total += std::exp(sum * discount - largest);
  }
  // At least one species may have no name in the table: the plant may be of none that it knows.
  const auto unnamed = std::max<std::int64_t>(parameters.species_alternatives - named, 1);
  total += static_cast<double>(unnamed) * std::exp(-largest);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i] <= 0.0F) continue;
    track.species_probability[i] =
        static_cast<float>(std::exp(sums[i] * discount - largest) / total);
  }
}

}  // namespace

void add_species_evidence(Track& track, const Observation& seen,
                          const TrackerParameters& parameters) {
  const std::vector<float>& probability = seen.species_probability;
  const double weight = seen.truncated ? parameters.class_truncated_weight : 1.0;
  const bool named = std::ranges::any_of(probability, [](float p) { return p > 0.0F; });
  if (!named || weight <= 0.0) return;
  if (track.species_log_odds.size() < probability.size()) {
    track.species_log_odds.resize(probability.size(), 0.0F);
  }
  const double c = parameters.species_confusion;
  const double odds = (1.0 - c) * static_cast<double>(parameters.species_alternatives) / c;
  for (std::size_t i = 0; i < probability.size(); ++i) {
    if (probability[i] <= 0.0F) continue;
    track.species_log_odds[i] += static_cast<float>(weight * std::log1p(odds * probability[i]));
  }
  track.species_views += weight;
  update_probability(track, parameters);
}

void merge_species_evidence(Track& kept, const Track& other, const TrackerParameters& parameters) {
  const std::vector<float>& more = other.species_log_odds;
  if (more.empty()) return;
  if (kept.species_log_odds.size() < more.size()) kept.species_log_odds.resize(more.size(), 0.0F);
  for (std::size_t i = 0; i < more.size(); ++i) kept.species_log_odds[i] += more[i];
  kept.species_views += other.species_views;
  update_probability(kept, parameters);
}

}  // namespace furrow::tracking
