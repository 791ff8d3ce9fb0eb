#include "fusion.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "furrow_core/distribution.hpp"
#include "species_fusion.hpp"

namespace furrow::tracking {
namespace {

constexpr double kMaxPosition_m = 1e7;
constexpr double kMaxRadius_m = 10.0;
constexpr std::size_t kMaxSpecies = 1024;
constexpr std::int32_t kMaxLeaves = 255;

bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

double log_odds(const std::array<double, kPlantClasses>& probability, double floor) {
  const double crop =
      std::clamp(probability[0] / (probability[0] + probability[1]), floor, 1.0 - floor);
  return std::log(crop / (1.0 - crop));
}

void add_class_evidence(Track& track, const Observation& seen,
                        const TrackerParameters& parameters) {
  const double weight =
      parameters.class_evidence_weight * (seen.truncated ? parameters.class_truncated_weight : 1.0);
  track.class_log_odds += weight * log_odds(seen.class_probability, parameters.class_floor);
  set_class(track, 0.0, parameters.class_max_log_odds);
}

void apply_floor(Eigen::Matrix2d& covariance, double floor_m) {
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  const double least = 0.5 * covariance.trace() - std::hypot(half_difference, covariance(0, 1));
  const double lacking = floor_m * floor_m - least;
  if (lacking > 0.0) covariance.diagonal().array() += lacking;
}

void fuse_size(Track& track, const Observation& seen, double memory_views) {
  if (seen.truncated && track.whole_views > 0) return;
  if (seen.truncated) {
    track.radius_m = std::max(track.radius_m, seen.radius_m);
    track.area_mm2 = std::max(track.area_mm2, seen.area_mm2);
    track.leaves = std::max(track.leaves, static_cast<double>(seen.leaves));
    return;
  }
  ++track.whole_views;
  const double share = 1.0 / std::min<double>(track.whole_views, memory_views);
  track.radius_m += share * (seen.radius_m - track.radius_m);
  track.area_mm2 += share * (seen.area_mm2 - track.area_mm2);
  if (seen.leaves > 0) track.leaves += share * (seen.leaves - track.leaves);
  if (!seen.footprint.empty()) track.footprint = seen.footprint;
}

}  // namespace

void set_class(Track& track, double prior_log_odds, double bound) {
  track.class_log_odds = std::clamp(track.class_log_odds, -bound, bound);
  const double crop = 1.0 / (1.0 + std::exp(-(track.class_log_odds + prior_log_odds)));
  track.class_probability = {crop, 1.0 - crop};
}

bool is_valid(const Observation& o) {
  const Eigen::Matrix2d& c = o.covariance_F_m2;
  const bool position = o.p_F_m.allFinite() && o.p_F_m.cwiseAbs().maxCoeff() <= kMaxPosition_m;
  const bool covariance = c.allFinite() && c(0, 0) > 0.0 && c(1, 1) > 0.0 &&
                          c.determinant() > 0.0 && std::abs(c(0, 1) - c(1, 0)) <= 1e-6 * c.trace();
  const bool size =
      within(o.radius_m, 0.0, kMaxRadius_m) && within(o.area_mm2, 0.0, kMaxRadius_m * 1e8);
  const bool plant_class = within(o.class_probability[0], 0.0, 1e300) &&
                           within(o.class_probability[1], 0.0, 1e300) &&
                           o.class_probability[0] + o.class_probability[1] > 0.0;
  const bool species =
      o.species_probability.size() <= kMaxSpecies && is_distribution(o.species_probability);
  const bool leaves = o.leaves >= 0 && o.leaves <= kMaxLeaves;
  return position && covariance && size && within(o.score, 0.0, 1.0) && plant_class && species &&
         leaves;
}

bool is_covariance(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return false;
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!covariance.isApprox(covariance.transpose(), 1e-6) && scale > 0.0) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0) >= -1e-9 * scale;
}

Track begin_track(const PreparedObservation& observation, Time stamp,
                  const TrackerParameters& parameters) {
  const Observation& seen = *observation.source;
  Track track;
  track.p_F_m = observation.p_F;
  track.covariance_F_m2 = observation.covariance;
  apply_floor(track.covariance_F_m2, parameters.position_floor_m);
  fuse_size(track, seen, parameters.size_memory_views);
  track.score = seen.score;
  add_class_evidence(track, seen, parameters);
  add_species_evidence(track, seen, parameters);
  track.views = 1;
  track.first_seen = stamp;
  track.last_seen = stamp;
  return track;
}

void fuse(Track& track, const PreparedObservation& observation, Time stamp,
          const TrackerParameters& parameters) {
  const Observation& seen = *observation.source;
  const Eigen::Matrix2d P = predicted_covariance(track, stamp, parameters.drift_m_per_sqrt_s);
  const Eigen::Vector2d innovation = observation.p_F - track.p_F_m;
  Eigen::Matrix2d R = observation.covariance;
  const double distance = std::sqrt(innovation.dot((P + R).inverse() * innovation));
  if (distance > parameters.outlier_sigma) R *= distance / parameters.outlier_sigma;
  const Eigen::Matrix2d gain = P * (P + R).inverse();
  const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - gain;
  track.p_F_m += gain * innovation;
  track.covariance_F_m2 = rest * P * rest.transpose() + gain * R * gain.transpose();
  apply_floor(track.covariance_F_m2, parameters.position_floor_m);
  track.recent_displacement_m += 0.5 * (innovation.norm() - track.recent_displacement_m);

  fuse_size(track, seen, parameters.size_memory_views);
  add_class_evidence(track, seen, parameters);
  add_species_evidence(track, seen, parameters);
  ++track.views;
  track.score += (seen.score - track.score) / track.views;
  track.misses = 0;
  track.last_seen = stamp;
}

void absorb(Track& kept, const Track& other, const TrackerParameters& parameters) {
  const Eigen::Matrix2d gain =
      kept.covariance_F_m2 * (kept.covariance_F_m2 + other.covariance_F_m2).inverse();
  const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - gain;
  kept.p_F_m += gain * (other.p_F_m - kept.p_F_m);
  kept.covariance_F_m2 = rest * kept.covariance_F_m2 * rest.transpose() +
                         gain * other.covariance_F_m2 * gain.transpose();
  apply_floor(kept.covariance_F_m2, parameters.position_floor_m);

  kept.class_log_odds += other.class_log_odds;
  set_class(kept, 0.0, parameters.class_max_log_odds);
  merge_species_evidence(kept, other, parameters);
  const double share = static_cast<double>(other.views) / (kept.views + other.views);
  kept.score += share * (other.score - kept.score);
  if (other.last_seen > kept.last_seen && other.whole_views > 0) {
    kept.radius_m = other.radius_m;
    kept.area_mm2 = other.area_mm2;
    kept.leaves = other.leaves;
    kept.footprint = other.footprint;
    kept.recent_displacement_m = other.recent_displacement_m;
  }
  kept.views += other.views;
  kept.whole_views += other.whole_views;
  kept.misses = std::min(kept.misses, other.misses);
  kept.misses_total += other.misses_total;
  kept.first_seen = std::min(kept.first_seen, other.first_seen);
  kept.last_seen = std::max(kept.last_seen, other.last_seen);
}

}  // namespace furrow::tracking
