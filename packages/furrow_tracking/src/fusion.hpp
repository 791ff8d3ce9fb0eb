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
/// Refines a track by an observation: position by a Kalman filter for a landmark that stands still,
/// with the weight of outliers reduced (Huber 1964); class by Bayes' rule with floored likelihoods;
/// radius and area by a running mean.
void fuse(Track& track, const PreparedObservation& observation, Time stamp,
          const TrackerParameters& parameters);
/// Sets the probability of class from the views' evidence, which is brought within the bound, and
/// what else is known.
void set_class(Track& track, double prior_log_odds, double bound);
/// Joins what two tracks know of the same plant; `kept` keeps its id and state.
void absorb(Track& kept, const Track& other, const TrackerParameters& parameters);

}  // namespace furrow::tracking
