#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_tracking/observation.hpp"
#include "furrow_tracking/row_prior.hpp"
#include "furrow_tracking/track.hpp"

namespace furrow::tracking {

struct TrackerParameters {
  std::string association = "dynamic_radius";
  double min_radius_m = 0.010;
  double max_radius_m = 0.050;
  double displacement_gain = 1.0;
  double uncertainty_gain = 2.0;
  double size_weight = 0.2;
  double fixed_radius_m = 0.030;
  double min_iou = 0.1;

  double birth_score = 0.5;
  double match_score = 0.3;
  std::int64_t confirm_matches = 3;
  std::int64_t tentative_misses = 2;
  std::int64_t confirmed_misses = 5;
  double visible_margin_m = 0.03;
  double keep_distance_m = 10.0;
  std::int64_t max_tracks = 8192;
  std::int64_t max_observations = 4096;
  double duplicate_ratio = 0.5;

  double position_floor_m = 0.0005;
  double drift_m_per_sqrt_s = 0.0005;
  double repeat_distance_m = 0.0;
  double truncated_sigma_ratio = 0.5;
  double max_pose_sigma_m = 0.010;
  double outlier_sigma = 3.0;
  double class_floor = 0.1;
  double class_evidence_weight = 1.0;
  double class_truncated_weight = 1.0;
  double class_max_log_odds = 8.0;
  double species_confusion = 0.1;
  std::int64_t species_alternatives = 12;
  double species_view_correlation = 0.5;
  double size_memory_views = 10.0;
  bool follow_pose = true;
  double follow_behind_m = 0.5;
  RowPriorParameters rows;

  void visit(ParameterVisitor& v);
  /// Throws ConfigError when a parameter is out of its range or contradicts another.
  void check() const;

 private:
  void visit_association(ParameterVisitor& v);
  void visit_lifetime(ParameterVisitor& v);
  void visit_limits(ParameterVisitor& v);
  void visit_position(ParameterVisitor& v);
  void visit_repeats(ParameterVisitor& v);
  void visit_class(ParameterVisitor& v);
  void visit_species(ParameterVisitor& v);
  void visit_pose(ParameterVisitor& v);
};

/// Why a view was rejected.
enum class ViewFault : std::uint8_t {
  kNone,
  kTimeNotNewer,   ///< its stamp is not after that of the newest view used
  kBadPose,        ///< not finite
  kBadCovariance,  ///< not finite, not symmetric, or with a negative variance
};

/// Counts of one update.
struct UpdateSummary {
  ViewFault fault = ViewFault::kNone;
  std::int32_t observations = 0;
  std::int32_t matched = 0;
  std::int32_t born = 0;
  std::int32_t confirmed = 0;
  std::int32_t missed = 0;      ///< unmatched tracks within the visible ground
  std::int32_t dropped = 0;     ///< ended for misses
  std::int32_t passed = 0;      ///< ended behind the robot
  std::int32_t merged = 0;      ///< ended as duplicates of another track
  std::int32_t evicted = 0;     ///< ended because the tracker was full
  std::int32_t rejected = 0;    ///< observations with a value that is not valid
  std::int32_t overflow = 0;    ///< observations beyond max_observations, not used
  std::int32_t weak = 0;        ///< below match_score, or unmatched and below birth_score
  std::int32_t duplicates = 0;  ///< second observations of a plant already matched
  bool empty_view = false;      ///< no valid observation
  bool repeated_view = false;   ///< from the viewpoint of the last view

  [[nodiscard]] bool ok() const { return fault == ViewFault::kNone && rejected + overflow == 0; }
};

/// Tracks plants as static landmarks of the field frame. Each update associates the observations of
/// one view with the tracks by optimal linear assignment. The cost is the distance over a dynamic
/// radius (Halstead et al. 2021) or one of two baselines. A Kalman filter refines the position,
/// Bayes' rule the class. The result does not depend on the order of the observations.
///
/// Pose errors up to `max_pose_sigma_m` count as independent between views. A greater error is
/// drift, common to consecutive views, and moves all plants alike. `position_floor_m` bounds the
/// standard deviation that averaging can reach.
///
/// With `follow_pose` tracks move with the corrections of the pose (View::correction) until the
/// robot has passed them by `follow_behind_m`. So a tool finds a plant that was seen from an
/// earlier, wrong pose. Footprints used to compare masks are not moved.
///
/// A view from within `repeat_distance_m` of the last one repeats its errors, as of a robot that
/// stands. It is evidence neither for nor against a plant. Matched tracks keep their state and are
/// as fresh as the view. No track begins, is confirmed, or counts a miss.
///
/// Cost: about linear in the plants in view; buffers are reused. Not thread-safe.
class Tracker {
 public:
  /// Throws ConfigError when a parameter is out of its range or contradicts another.
  explicit Tracker(TrackerParameters parameters = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// A view with a fault changes nothing. Observations that are not valid are counted and ignored.
  UpdateSummary update(const View& view, std::span<const Observation> observations);

  /// Ends every track (kFinished); they are then found in ended().
  void finish();

  /// Living tracks (not kEnded), in the order of id. Valid until the next update().
  [[nodiscard]] std::span<const Track> tracks() const;
  /// Tracks that ended in the last update() or finish(), in the order of id.
  [[nodiscard]] std::span<const Track> ended() const;
  /// For each observation of the last update: the id of its track, 0 where it has none.
  [[nodiscard]] std::span<const std::uint64_t> observation_track_ids() const;

  [[nodiscard]] const TrackerParameters& parameters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::tracking
