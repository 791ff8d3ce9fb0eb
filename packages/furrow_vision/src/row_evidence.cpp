#include "furrow_vision/row_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace furrow::vision {
namespace {

struct Vote {
  Eigen::Vector2d p_mm;
  double weight;
};

/// The line of points p with normal . p = offset_mm.
struct Row {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_mm = 0.0;
  double weight = 0.0;  ///< of the votes around the line

  [[nodiscard]] double distance_mm(const Eigen::Vector2d& p_mm) const {
    return std::abs(normal.dot(p_mm) - offset_mm);
  }
};

double nearness(double distance_mm, double sd_mm) {
  const double deviations = distance_mm / sd_mm;
  return std::exp(-0.5 * deviations * deviations);
}

std::vector<Vote> votes_of(const std::vector<RowPlant>& plants, double area_min_mm2) {
  std::vector<Vote> votes;
  for (const RowPlant& plant : plants) {
    if (plant.area_mm2 <= area_min_mm2) continue;
    const double probability = 1.0 / (1.0 + std::exp(-plant.crop_log_odds));
    votes.push_back({plant.p_mm, std::sqrt(plant.area_mm2) * probability});
  }
  // A stable order, so that the same plants give the same row.
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& a, const Vote& b) { return a.weight > b.weight; });
  if (votes.size() > kMaxRowPlants) votes.resize(kMaxRowPlants);
  return votes;
}

Row best_row(const std::vector<Vote>& votes, double sd_mm) {
  constexpr int kDirections = 60;
  Row best;
  std::vector<double> across(votes.size());
  for (int k = 0; k < kDirections; ++k) {
    const double angle_rad = std::numbers::pi * k / kDirections;
    const Eigen::Vector2d normal(std::cos(angle_rad), std::sin(angle_rad));
    std::transform(votes.begin(), votes.end(), across.begin(),
                   [&](const Vote& vote) { return normal.dot(vote.p_mm); });
    for (const double middle : across) {
      double weight = 0.0, moment = 0.0;
      for (std::size_t i = 0; i < votes.size(); ++i) {
        const double part = votes[i].weight * nearness(across[i] - middle, sd_mm);
        weight += part;
        moment += part * across[i];
      }
      if (weight > best.weight) best = {normal, moment / weight, weight};
    }
  }
  return best;
}

}  // namespace

std::vector<double> row_evidence(const std::vector<RowPlant>& plants,
                                 const RowEvidenceParameters& parameters) {
  constexpr std::size_t kLeastPlants = 3;
  constexpr double kLeastShare = 0.3;
  std::vector<double> evidence(plants.size(), 0.0);
  const std::vector<Vote> votes = votes_of(plants, parameters.area_min_mm2);
  if (votes.size() < kLeastPlants) return evidence;
  double all = 0.0;
  for (const Vote& vote : votes) all += vote.weight;
  const Row row = best_row(votes, parameters.sd_mm);
  if (row.weight <= 0.0) return evidence;
  const double certainty =
      std::clamp((row.weight / all - kLeastShare) / (1.0 - kLeastShare), 0.0, 1.0);
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const double near = nearness(row.distance_mm(plants[i].p_mm), parameters.sd_mm);
    evidence[i] = parameters.evidence_max * certainty * (2.0 * near - 1.0);
  }
  return evidence;
}

}  // namespace furrow::vision
