#include "furrow_tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "association.hpp"
#include "furrow_core/point_grid.hpp"
#include "fusion.hpp"
#include "viewpoint.hpp"

namespace furrow::tracking {
namespace {

constexpr std::int32_t kNoTrack = SparseAssignment::kUnmatched;

}  // namespace

class Tracker::Impl {
 public:
  explicit Impl(TrackerParameters parameters)
      : parameters_((parameters.check(), std::move(parameters))),
        association_(parameters_),
        row_prior_(parameters_.rows) {}

  UpdateSummary update(const View& view, std::span<const Observation> observations);
  void finish();

  const TrackerParameters parameters_;
  std::vector<Track> tracks_;
  std::vector<Track> ended_;
  std::vector<std::uint64_t> observation_track_ids_;

 private:
  [[nodiscard]] ViewFault fault_of(const View& view) const;
  void prepare(const View& view, std::span<const Observation> observations, UpdateSummary& summary);
  void follow_pose(const View& view);
  void refresh_matches(const View& view, UpdateSummary& summary);
  void fuse_matches(const View& view, UpdateSummary& summary);
  void begin_tracks(const View& view, UpdateSummary& summary);
  [[nodiscard]] bool repeats_a_plant(const PreparedObservation& observation) const;
  void count_misses(const View& view, std::size_t known, UpdateSummary& summary);
  void merge_duplicates(const View& view, UpdateSummary& summary);
  [[nodiscard]] std::int32_t seen_twin_of(const Track& track, Time now) const;
  void end_passed(const View& view, UpdateSummary& summary);
  void evict_farthest(const View& view, UpdateSummary& summary);
  void apply_row_prior();
  void take_out_ended();
  static void end(Track& track, EndReason reason) {
    track.state = TrackState::kEnded;
    track.end_reason = reason;
  }

  Association association_;
  RowPrior row_prior_;
  std::uint64_t next_id_ = 1;
  bool started_ = false;
  Time newest_;
  Viewpoint viewpoint_;
  std::vector<PreparedObservation> prepared_;
  std::vector<Eigen::Vector2d> observed_;  // positions of prepared_
  std::vector<std::int32_t> track_of_;     // of prepared_, index into tracks_
  std::vector<std::int32_t> birth_order_;
  std::vector<Eigen::Vector2d> seen_positions_;  // of tracks matched in this view
  std::vector<std::int32_t> seen_tracks_;
  std::vector<std::pair<double, std::int32_t>> by_distance_;
  PointGrid<Eigen::Vector2d> observation_grid_;
  PointGrid<Eigen::Vector2d> track_grid_;
};

ViewFault Tracker::Impl::fault_of(const View& view) const {
  if (started_ && view.stamp <= newest_) return ViewFault::kTimeNotNewer;
  for (const geometry::Pose2& pose : {view.X_FB, view.correction}) {
    if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m) || !std::isfinite(pose.heading_rad)) {
      return ViewFault::kBadPose;
    }
  }
  return is_covariance(view.pose_covariance) ? ViewFault::kNone : ViewFault::kBadCovariance;
}

void Tracker::Impl::prepare(const View& view, std::span<const Observation> observations,
                            UpdateSummary& summary) {
  prepared_.clear();
  const auto bound = static_cast<std::size_t>(parameters_.max_observations);
  const std::size_t looked_at = std::min(observations.size(), bound);
  const double pose_sigma_m = largest_sigma_m(view.pose_covariance.topLeftCorner<2, 2>());
  const double shared = std::min(parameters_.max_pose_sigma_m / std::max(pose_sigma_m, 1e-12), 1.0);
  const Eigen::Matrix3d pose_covariance = shared * shared * view.pose_covariance;
  summary.overflow = static_cast<std::int32_t>(observations.size() - looked_at);
  for (std::size_t i = 0; i < looked_at; ++i) {
    const Observation& seen = observations[i];
    if (!is_valid(seen)) {
      ++summary.rejected;
      continue;
    }
    if (seen.score < parameters_.match_score) {
      ++summary.weak;
      continue;
    }
    PreparedObservation& prepared = prepared_.emplace_back();
    prepared.source = &seen;
    prepared.index = static_cast<std::int32_t>(i);
    prepared.p_F = seen.p_F_m;
    Eigen::Matrix<double, 2, 3> by_pose;
    by_pose << 1.0, 0.0, -(seen.p_F_m.y() - view.X_FB.y_m),  //
        0.0, 1.0, seen.p_F_m.x() - view.X_FB.x_m;
    prepared.covariance = seen.covariance_F_m2 + by_pose * pose_covariance * by_pose.transpose();
    if (seen.truncated) {
      const double sigma_m = parameters_.truncated_sigma_ratio * seen.radius_m;
      prepared.covariance.diagonal().array() += sigma_m * sigma_m;
    }
  }
  const auto key = [](const PreparedObservation& o) {
    return std::tuple(o.p_F.x(), o.p_F.y(), o.source->radius_m, o.source->score, o.source->area_mm2,
                      o.source->class_probability, o.index);
  };
  std::sort(prepared_.begin(), prepared_.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  observed_.clear();
  for (const PreparedObservation& prepared : prepared_) observed_.push_back(prepared.p_F);
}

UpdateSummary Tracker::Impl::update(const View& view, std::span<const Observation> observations) {
  UpdateSummary summary;
  summary.observations = static_cast<std::int32_t>(observations.size());
  ended_.clear();
  observation_track_ids_.assign(observations.size(), 0);
  summary.fault = fault_of(view);
  if (summary.fault != ViewFault::kNone) return summary;
  started_ = true;
  newest_ = view.stamp;

  if (parameters_.follow_pose) follow_pose(view);
  prepare(view, observations, summary);
  summary.empty_view = prepared_.empty();
  const auto matches = association_.match(view.stamp, prepared_, tracks_);
  track_of_.assign(matches.begin(), matches.end());
  summary.repeated_view = viewpoint_.repeats(view, parameters_.repeat_distance_m);
  if (summary.repeated_view) {
    refresh_matches(view, summary);
  } else {
    const std::size_t known = tracks_.size();
    fuse_matches(view, summary);
    begin_tracks(view, summary);
    count_misses(view, known, summary);
    merge_duplicates(view, summary);
    end_passed(view, summary);
    evict_farthest(view, summary);
    apply_row_prior();
  }
  for (std::size_t o = 0; o < prepared_.size(); ++o) {
    if (track_of_[o] == kNoTrack) continue;
    const Track& track = tracks_[track_of_[o]];
    observation_track_ids_[prepared_[o].index] =
        track.end_reason == EndReason::kMerged ? track.merged_into : track.id;
  }
  take_out_ended();
  return summary;
}

void Tracker::Impl::follow_pose(const View& view) {
  const Eigen::Vector2d p_FB(view.X_FB.x_m, view.X_FB.y_m);
  const Eigen::Vector2d ahead_F(std::cos(view.X_FB.heading_rad), std::sin(view.X_FB.heading_rad));
  for (Track& track : tracks_) {
    if (ahead_F.dot(track.p_F_m - p_FB) < -parameters_.follow_behind_m) continue;
    track.p_F_m = geometry::transform(view.correction, track.p_F_m);
  }
}

void Tracker::Impl::refresh_matches(const View& view, UpdateSummary& summary) {
  for (const std::int32_t t : track_of_) {
    if (t == kNoTrack) continue;
    tracks_[t].last_seen = view.stamp;
    if (tracks_[t].confirmed) tracks_[t].state = TrackState::kConfirmed;
    ++summary.matched;
  }
}

void Tracker::Impl::fuse_matches(const View& view, UpdateSummary& summary) {
  for (std::size_t o = 0; o < prepared_.size(); ++o) {
    if (track_of_[o] == kNoTrack) continue;
    Track& track = tracks_[track_of_[o]];
    fuse(track, prepared_[o], view.stamp, parameters_);
    ++summary.matched;
    if (!track.confirmed && track.views >= parameters_.confirm_matches) {
      track.confirmed = true;
      ++summary.confirmed;
    }
    if (track.confirmed) track.state = TrackState::kConfirmed;
  }
}

bool Tracker::Impl::repeats_a_plant(const PreparedObservation& observation) const {
  bool repeats = false;
  const double reach_m = parameters_.duplicate_ratio * observation.source->radius_m;
  if (reach_m <= 0.0) return false;
  observation_grid_.for_each_within(
      observation.p_F, reach_m, [&](std::size_t other, double distance_m) {
        repeats = repeats ||
                  (track_of_[other] != kNoTrack &&
                   distance_m <= parameters_.duplicate_ratio * prepared_[other].source->radius_m);
      });
  return repeats;
}

void Tracker::Impl::begin_tracks(const View& view, UpdateSummary& summary) {
  birth_order_.clear();
  for (std::size_t o = 0; o < prepared_.size(); ++o) {
    if (track_of_[o] == kNoTrack) birth_order_.push_back(static_cast<std::int32_t>(o));
  }
  if (birth_order_.empty()) return;
  std::sort(birth_order_.begin(), birth_order_.end(), [&](std::int32_t a, std::int32_t b) {
    const double score_a = prepared_[a].source->score;
    const double score_b = prepared_[b].source->score;
    return score_a != score_b ? score_a > score_b : a < b;
  });
  observation_grid_.build(observed_, parameters_.max_radius_m);
  for (const std::int32_t o : birth_order_) {
    if (prepared_[o].source->score < parameters_.birth_score) {
      ++summary.weak;
      continue;
    }
    if (repeats_a_plant(prepared_[o])) {
      ++summary.duplicates;
      continue;
    }
    track_of_[o] = static_cast<std::int32_t>(tracks_.size());
    Track& track = tracks_.emplace_back(begin_track(prepared_[o], view.stamp, parameters_));
    track.id = next_id_++;
    ++summary.born;
    if (parameters_.confirm_matches <= 1) {
      track.confirmed = true;
      track.state = TrackState::kConfirmed;
      ++summary.confirmed;
    }
  }
}

void Tracker::Impl::count_misses(const View& view, std::size_t known, UpdateSummary& summary) {
  for (std::size_t t = 0; t < known; ++t) {
    Track& track = tracks_[t];
    if (track.last_seen == view.stamp) continue;
    if (track.confirmed) track.state = TrackState::kCoasting;
    if (!view.visible.contains(track.p_F_m, parameters_.visible_margin_m)) continue;
    ++track.misses;
    ++track.misses_total;
    ++summary.missed;
    const std::int64_t allowed =
        track.confirmed ? parameters_.confirmed_misses : parameters_.tentative_misses;
    if (track.misses >= allowed) {
      end(track, EndReason::kMissed);
      ++summary.dropped;
    }
  }
}

std::int32_t Tracker::Impl::seen_twin_of(const Track& track, Time now) const {
  std::int32_t twin = kNoTrack;
  double nearest_m = 0.0;
  const double spread =
      largest_sigma_m(predicted_covariance(track, now, parameters_.drift_m_per_sqrt_s));
  const double reach_m = parameters_.max_radius_m;
  track_grid_.for_each_within(track.p_F_m, reach_m, [&](std::size_t seen, double distance_m) {
    const Track& other = tracks_[seen_tracks_[seen]];
    // Two tracks that were seen side by side are two plants; one that was missed only now may
    // have been seen beside the other.
    if (track.misses < 2 && track.last_seen >= other.first_seen) return;
    const double allowed_m =
        parameters_.duplicate_ratio * std::min(track.radius_m, other.radius_m) +
        parameters_.uncertainty_gain * std::hypot(spread, largest_sigma_m(other.covariance_F_m2));
    if (distance_m > allowed_m) return;
    if (twin == kNoTrack || distance_m < nearest_m) {
      twin = seen_tracks_[seen];
      nearest_m = distance_m;
    }
  });
  return twin;
}

void Tracker::Impl::merge_duplicates(const View& view, UpdateSummary& summary) {
  if (parameters_.duplicate_ratio <= 0.0 || summary.missed == 0) return;
  seen_positions_.clear();
  seen_tracks_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (tracks_[t].last_seen != view.stamp) continue;
    seen_positions_.push_back(tracks_[t].p_F_m);
    seen_tracks_.push_back(static_cast<std::int32_t>(t));
  }
  track_grid_.build(seen_positions_, parameters_.max_radius_m);
  for (Track& missed : tracks_) {
    if (missed.state == TrackState::kEnded || missed.misses == 0 ||
        missed.last_seen == view.stamp) {
      continue;
    }
    const std::int32_t twin = seen_twin_of(missed, view.stamp);
    if (twin == kNoTrack || tracks_[twin].state == TrackState::kEnded) continue;
    Track& seen = tracks_[twin];
    // The identity that others know of lives on: the confirmed one, then the older one.
    const bool keep_missed =
        missed.confirmed != seen.confirmed ? missed.confirmed : missed.id < seen.id;
    Track& kept = keep_missed ? missed : seen;
    Track& gone = keep_missed ? seen : missed;
    absorb(kept, gone, parameters_);
    if (!kept.confirmed && kept.views >= parameters_.confirm_matches) {
      kept.confirmed = true;
      ++summary.confirmed;
    }
    if (kept.confirmed) kept.state = TrackState::kConfirmed;
    gone.merged_into = kept.id;
    end(gone, EndReason::kMerged);
    ++summary.merged;
  }
}

void Tracker::Impl::end_passed(const View& view, UpdateSummary& summary) {
  const Eigen::Vector2d p_FB(view.X_FB.x_m, view.X_FB.y_m);
  for (Track& track : tracks_) {
    if (track.state == TrackState::kEnded || track.last_seen == view.stamp) continue;
    if ((track.p_F_m - p_FB).norm() > parameters_.keep_distance_m) {
      end(track, EndReason::kPassed);
      ++summary.passed;
    }
  }
}

void Tracker::Impl::evict_farthest(const View& view, UpdateSummary& summary) {
  const auto bound = static_cast<std::size_t>(parameters_.max_tracks);
  if (tracks_.size() <= bound) return;
  by_distance_.clear();
  const Eigen::Vector2d p_FB(view.X_FB.x_m, view.X_FB.y_m);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (tracks_[t].state == TrackState::kEnded) continue;
    by_distance_.emplace_back((tracks_[t].p_F_m - p_FB).norm(), static_cast<std::int32_t>(t));
  }
  if (by_distance_.size() <= bound) return;
  std::nth_element(by_distance_.begin(), by_distance_.begin() + static_cast<std::ptrdiff_t>(bound),
                   by_distance_.end());
  for (std::size_t i = bound; i < by_distance_.size(); ++i) {
    end(tracks_[by_distance_[i].second], EndReason::kEvicted);
    ++summary.evicted;
  }
}

void Tracker::Impl::apply_row_prior() {
  if (!parameters_.rows.row_prior) return;
  row_prior_.learn(tracks_);
  for (Track& track : tracks_) {
    set_class(track, row_prior_.log_odds(track.p_F_m.y()), parameters_.class_max_log_odds);
  }
}

void Tracker::Impl::take_out_ended() {
  const auto living = [](const Track& track) { return track.state != TrackState::kEnded; };
  const auto first_ended = std::stable_partition(tracks_.begin(), tracks_.end(), living);
  ended_.insert(ended_.end(), std::make_move_iterator(first_ended),
                std::make_move_iterator(tracks_.end()));
  tracks_.erase(first_ended, tracks_.end());
}

void Tracker::Impl::finish() {
  ended_.clear();
  for (Track& track : tracks_) end(track, EndReason::kFinished);
  take_out_ended();
}

Tracker::Tracker(TrackerParameters parameters)
    : impl_(std::make_unique<Impl>(std::move(parameters))) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

UpdateSummary Tracker::update(const View& view, std::span<const Observation> observations) {
  return impl_->update(view, observations);
}
void Tracker::finish() {
  impl_->finish();
}
std::span<const Track> Tracker::tracks() const {
  return impl_->tracks_;
}
std::span<const Track> Tracker::ended() const {
  return impl_->ended_;
}
std::span<const std::uint64_t> Tracker::observation_track_ids() const {
  return impl_->observation_track_ids_;
}
const TrackerParameters& Tracker::parameters() const {
  return impl_->parameters_;
}

}  // namespace furrow::tracking
