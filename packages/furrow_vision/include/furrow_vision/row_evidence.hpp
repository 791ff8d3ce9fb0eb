#pragma once

#include <Eigen/Core>
#include <vector>

namespace furrow::vision {

/// A plant as evidence of the row that it may stand in.
struct RowPlant {
  Eigen::Vector2d p_mm = Eigen::Vector2d::Zero();  ///< of its stem on the ground; any origin
  double area_mm2 = 0.0;
  double crop_log_odds = 0.0;  ///< of the plant alone
};

struct RowEvidenceParameters {
  double evidence_max = 1.0;  ///< log-odds of a crop on the row, and against one far from it
  double sd_mm = 50.0;        ///< across the row; > 0
  double area_min_mm2 = 200.0;
};

/// Plants that vote for a row, at most.
inline constexpr std::size_t kMaxRowPlants = 200;

/// Log-odds of a crop for each plant, from its distance to the row that most crop plants share.
///
/// Each plant votes with sqrt(area) x probability of a crop. The row is the line of any direction
/// through a plant with the most votes around it, weighted by a normal kernel of `sd_mm` across.
/// The row's share of all votes bounds the evidence: none up to 0.3, all of it at 1. Fewer than
/// three plants above `area_min_mm2` are no row, and the evidence is 0. Only the kMaxRowPlants
/// heaviest plants vote, so that the time is bounded.
[[nodiscard]] std::vector<double> row_evidence(const std::vector<RowPlant>& plants,
                                               const RowEvidenceParameters& parameters);

}  // namespace furrow::vision
