#include "crop_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace furrow::vision {

void add_row_votes(const std::vector<RowVote>& votes, double spacing_px, double sd_px,
                   double memory, std::vector<double>& profile) {
  constexpr std::size_t kPhases = 100;
  if (profile.size() != kPhases) profile.assign(kPhases, 0.0);
  for (std::size_t k = 0; k < kPhases; ++k) {
    const double phase_px = static_cast<double>(k) / kPhases * spacing_px;
    double sum = 0.0;
    for (const RowVote& vote : votes) {
      const double off_px = std::remainder(vote.u_px - phase_px, spacing_px) / sd_px;
      sum += vote.weight * std::exp(-0.5 * off_px * off_px);
    }
    profile[k] = memory * profile[k] + (1.0 - memory) * sum;
  }
}

std::vector<double> rows_of_profile(const std::vector<double>& profile, double spacing_px,
                                    double width_px, double margin_px, double contrast_min) {
  std::vector<double> rows;
  if (profile.empty()) return rows;
  const double mean =
      std::accumulate(profile.begin(), profile.end(), 0.0) / static_cast<double>(profile.size());
  const auto best = std::max_element(profile.begin(), profile.end());
  if (!(*best > 0.0) || *best < contrast_min * mean) return rows;
  const double phase_px = static_cast<double>(best - profile.begin()) /
                          static_cast<double>(profile.size()) * spacing_px;
  const double first = std::ceil((-margin_px - phase_px) / spacing_px);
  for (double k = first; phase_px + k * spacing_px <= width_px + margin_px; k += 1.0) {
    rows.push_back(phase_px + k * spacing_px);
  }
  return rows;
}

}  // namespace furrow::vision
