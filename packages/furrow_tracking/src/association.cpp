#include "association.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace furrow::tracking {
namespace {

constexpr double kForbidden = std::numeric_limits<double>::infinity();

double circle_iou(double r, double s, double d) {
  if (r <= 0.0 || s <= 0.0 || d >= r + s) return 0.0;
  const double small = std::min(r, s);
  const double all = std::numbers::pi * (r * r + s * s);
  if (d <= std::abs(r - s)) {
    const double common = std::numbers::pi * small * small;
    return common / (all - common);
  }
  const double alpha = std::acos(std::clamp((d * d + r * r - s * s) / (2.0 * d * r), -1.0, 1.0));
  const double beta = std::acos(std::clamp((d * d + s * s - r * r) / (2.0 * d * s), -1.0, 1.0));
  const double common =
      r * r * (alpha - 0.5 * std::sin(2.0 * alpha)) + s * s * (beta - 0.5 * std::sin(2.0 * beta));
  return common / (all - common);
}

}  // namespace

double largest_sigma_m(const Eigen::Matrix2d& covariance) {
  const double mean = 0.5 * covariance.trace();
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(std::max(0.0, mean + std::hypot(half_difference, covariance(0, 1))));
}

Eigen::Matrix2d predicted_covariance(const Track& track, Time now, double drift) {
  const double elapsed_s = std::max(0.0, (now - track.last_seen).to_seconds());
  return track.covariance_F_m2 + Eigen::Matrix2d::Identity() * (drift * drift * elapsed_s);
}

Association::Association(const TrackerParameters& parameters)
    : parameters_(parameters),
      method_(parameters.association == "dynamic_radius" ? Method::kDynamicRadius
              : parameters.association == "fixed_radius" ? Method::kFixedRadius
                                                         : Method::kIou),
      unmatched_cost_(method_ == Method::kIou ? 1.0 - parameters.min_iou : 1.0) {}

double Association::base_reach_m(const Track& track, Time now) const {
  switch (method_) {
    case Method::kFixedRadius:
      return parameters_.fixed_radius_m;
    case Method::kIou:
      return track.radius_m;
    case Method::kDynamicRadius:
      break;
  }
  const double sigma_m =
      largest_sigma_m(predicted_covariance(track, now, parameters_.drift_m_per_sqrt_s));
  const double radius_m =
      std::clamp(track.radius_m, parameters_.min_radius_m, parameters_.max_radius_m) +
      parameters_.displacement_gain * track.recent_displacement_m +
      parameters_.uncertainty_gain * sigma_m;
  return std::min(radius_m, 2.0 * parameters_.max_radius_m);
}

double Association::full_reach_m(double base_reach_m,
                                 const PreparedObservation& observation) const {
  switch (method_) {
    case Method::kFixedRadius:
      return base_reach_m;
    case Method::kIou:
      return base_reach_m + observation.source->radius_m;
    case Method::kDynamicRadius:
      break;
  }
  return std::min(
      base_reach_m + parameters_.uncertainty_gain * largest_sigma_m(observation.covariance),
      2.0 * parameters_.max_radius_m);
}

double Association::cost(const PreparedObservation& observation, const Track& track,
                         double base_reach_m, double distance_m) const {
  const Observation& seen = *observation.source;
  if (method_ == Method::kIou) {
    const bool masks = !seen.footprint.empty() && !track.footprint.empty() &&
                       seen.footprint.cell_m() == track.footprint.cell_m();
    return 1.0 - (masks ? GroundMask::iou(seen.footprint, track.footprint)
                        : circle_iou(seen.radius_m, track.radius_m, distance_m));
  }
  const double ratio = distance_m / full_reach_m(base_reach_m, observation);
  if (ratio > 1.0) return kForbidden;
  if (method_ == Method::kFixedRadius || seen.truncated || track.whole_views == 0) return ratio;
  const double change =
      std::abs(std::log(std::max(seen.radius_m, 1e-3) / std::max(track.radius_m, 1e-3)));
  return ratio * (1.0 + parameters_.size_weight * std::min(change, 2.0));
}

void Association::select_candidates(Time now, std::span<const PreparedObservation> observations,
                                    std::span<const Track> tracks) {
  candidates_.clear();
  positions_.clear();
  reach_m_.clear();
  greatest_reach_m_ = 0.0;
  if (observations.empty()) return;
  Eigen::Vector2d lower = observations[0].p_F;
  Eigen::Vector2d upper = lower;
  for (const PreparedObservation& observation : observations) {
    lower = lower.cwiseMin(observation.p_F);
    upper = upper.cwiseMax(observation.p_F);
    greatest_reach_m_ = std::max(greatest_reach_m_, full_reach_m(0.0, observation));
  }
  double greatest_base_m = 0.0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track& track = tracks[t];
    const double base_m = base_reach_m(track, now);
    const double slack_m = base_m + greatest_reach_m_;
    if (((track.p_F_m - lower).array() < -slack_m).any() ||
        ((track.p_F_m - upper).array() > slack_m).any()) {
      continue;
    }
    candidates_.push_back(static_cast<std::int32_t>(t));
    positions_.push_back(track.p_F_m);
    reach_m_.push_back(base_m);
    greatest_base_m = std::max(greatest_base_m, base_m);
  }
  greatest_reach_m_ += greatest_base_m;
}

std::span<const std::int32_t> Association::match(Time now,
                                                 std::span<const PreparedObservation> observations,
                                                 std::span<const Track> tracks) {
  select_candidates(now, observations, tracks);
  pairs_.clear();
  grid_.build(positions_, std::max(greatest_reach_m_, 1e-3));
  for (std::size_t o = 0; o < observations.size(); ++o) {
    grid_.for_each_within(
        observations[o].p_F, greatest_reach_m_, [&](std::size_t candidate, double distance_m) {
          const double pair_cost = cost(observations[o], tracks[candidates_[candidate]],
                                        reach_m_[candidate], distance_m);
          if (pair_cost <= unmatched_cost_) {
            pairs_.push_back(
                {static_cast<std::int32_t>(o), static_cast<std::int32_t>(candidate), pair_cost});
          }
        });
  }
  const auto columns =
      assignment_.solve(static_cast<std::int32_t>(observations.size()),
                        static_cast<std::int32_t>(candidates_.size()), pairs_, unmatched_cost_);
  track_of_observation_.clear();
  for (const std::int32_t column : columns) {
    track_of_observation_.push_back(column == SparseAssignment::kUnmatched
                                        ? SparseAssignment::kUnmatched
                                        : candidates_[column]);
  }
  return track_of_observation_;
}

}  // namespace furrow::tracking
