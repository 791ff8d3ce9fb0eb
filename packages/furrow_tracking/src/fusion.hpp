#pragma once

#include "association.hpp"
#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {

/// Whether every value of an observation is in its documented range.
[[nodiscard]] bool is_valid(const Observation& observation);
/// Finite, symmetric and positive semi-definite.
[[nodiscard]] bool is_covariance(const Eigen::Matrix3d& covariance);

/// A track that begins with an observation; its id and state are the caller's.
[[nodiscard]] Track begin_track(const PreparedObservation& observation, Time stamp,
                                const TrackerParameters& parameters);
/// Refines a track by an observation. Position: a Kalman filter for a static landmark, with reduced
/// weight of outliers (Huber 1964). Class: Bayes' rule with floored likelihoods. Species: see
/// species_fusion.hpp. Radius and area: a running mean.
void fuse(Track& track, const PreparedObservation& observation, Time stamp,
          const TrackerParameters& parameters);
/// Sets the class probability from the evidence of the views, clamped to the bound, and the prior.
void set_class(Track& track, double prior_log_odds, double bound);
/// Merges two tracks of the same plant; `kept` keeps its id and state.
void absorb(Track& kept, const Track& other, const TrackerParameters& parameters);

}  // namespace furrow::tracking
