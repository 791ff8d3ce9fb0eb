#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "furrow_core/point_grid.hpp"
#include "furrow_tracking/assignment.hpp"
#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {

/// An observation that passed the checks, with what the view adds to it.
struct PreparedObservation {
  const Observation* source = nullptr;
  std::int32_t index = 0;  ///< in the caller's span
  Eigen::Vector2d p_F = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of stem and pose together
};

/// The greatest standard deviation of a 2 x 2 covariance.
[[nodiscard]] double largest_sigma_m(const Eigen::Matrix2d& covariance);
/// The track's position covariance after it was not seen until `now`.
[[nodiscard]] Eigen::Matrix2d predicted_covariance(const Track& track, Time now, double drift);

/// Matches the observations of one view to tracks.
class Association {
 public:
  explicit Association(const TrackerParameters& parameters);

  /// For each observation the index into `tracks`, or SparseAssignment::kUnmatched; valid until the
  /// next call.
  std::span<const std::int32_t> match(Time now, std::span<const PreparedObservation> observations,
                                      std::span<const Track> tracks);

 private:
  enum class Method : std::uint8_t { kDynamicRadius, kFixedRadius, kIou };

  void select_candidates(Time now, std::span<const PreparedObservation> observations,
                         std::span<const Track> tracks);
  /// Not finite or above unmatched_cost_ when the two may not be matched.
  [[nodiscard]] double cost(const PreparedObservation& observation, const Track& track,
                            double base_reach_m, double distance_m) const;
  [[nodiscard]] double base_reach_m(const Track& track, Time now) const;
  [[nodiscard]] double full_reach_m(double base_reach_m,
                                    const PreparedObservation& observation) const;

  const TrackerParameters& parameters_;
  Method method_;
  double unmatched_cost_;
  SparseAssignment assignment_;
  PointGrid<Eigen::Vector2d> grid_;
  std::vector<std::int32_t> candidates_;    // indices into tracks
  std::vector<Eigen::Vector2d> positions_;  // of the candidates
  std::vector<double> reach_m_;             // of the candidates
  double greatest_reach_m_ = 0.0;
  std::vector<CandidatePair> pairs_;
  std::vector<std::int32_t> track_of_observation_;
};

}  // namespace furrow::tracking
