#include "furrow_tracking/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "furrow_core/error.hpp"
#include "furrow_tracking/assignment.hpp"

namespace furrow::tracking {
namespace {

constexpr double kAcceptedSimilarity = 0.5;
constexpr int kThresholds = 19;
constexpr std::int32_t kNone = SparseAssignment::kUnmatched;

std::int32_t dense_id(std::vector<std::int64_t>& known, std::map<std::int64_t, std::int32_t>& index,
                      std::int64_t id) {
  const auto [entry, added] = index.try_emplace(id, static_cast<std::int32_t>(known.size()));
  if (added) known.push_back(id);
  return entry->second;
}

Status check_points(std::span<const LabelledPoint> points) {
  std::vector<std::int64_t> ids;
  for (const LabelledPoint& point : points) {
    if (!point.p_F_m.allFinite()) {
      return Error{ErrorCode::kInvalidArgument,
                   "the position of id " + std::to_string(point.id) + " is not finite"};
    }
    ids.push_back(point.id);
  }
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end()) {
    return Error{ErrorCode::kInvalidArgument,
                 "id " + std::to_string(*twice) + " stands twice in one frame"};
  }
  return {};
}

}  // namespace

TrackingEvaluation::TrackingEvaluation(double zero_similarity_distance_m)
    : zero_similarity_distance_m_(zero_similarity_distance_m) {
  if (!(zero_similarity_distance_m > 0.0) || !std::isfinite(zero_similarity_distance_m)) {
    throw ConfigError("the distance of zero similarity is not positive");
  }
}

Status TrackingEvaluation::add_frame(std::span<const LabelledPoint> truth,
                                     std::span<const LabelledPoint> tracks) {
  if (Status status = check_points(truth); !status) return status;
  if (Status status = check_points(tracks); !status) return status;
  Frame& frame = frames_.emplace_back();
  for (const LabelledPoint& point : truth) {
    frame.truth.push_back(dense_id(truth_ids_, truth_index_, point.id));
  }
  for (const LabelledPoint& point : tracks) {
    frame.tracks.push_back(dense_id(track_ids_, track_index_, point.id));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      const double similarity =
          1.0 - (truth[i].p_F_m - tracks[j].p_F_m).norm() / zero_similarity_distance_m_;
      if (similarity <= 0.0) continue;
      frame.pairs.push_back(
          {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), similarity});
    }
  }
  return {};
}

void TrackingEvaluation::score_clear_mot(TrackingScores& scores) const {
  SparseAssignment assignment;
  std::vector<CandidatePair> candidates;
  std::vector<std::int32_t> last_track(truth_ids_.size(), kNone);      // ever
  std::vector<std::int32_t> previous_track(truth_ids_.size(), kNone);  // in the frame before
  std::vector<std::int32_t> current_track;
  for (const Frame& frame : frames_) {
    candidates.clear();
    for (const Pair& pair : frame.pairs) {
      if (pair.similarity < kAcceptedSimilarity) continue;
      // A pair of the frame before goes before all others.
      const bool continues = previous_track[frame.truth[pair.truth]] == frame.tracks[pair.track];
      candidates.push_back({pair.truth, pair.track, (continues ? -1000.0 : 0.0) - pair.similarity});
    }
    const auto columns =
        assignment.solve(static_cast<std::int32_t>(frame.truth.size()),
                         static_cast<std::int32_t>(frame.tracks.size()), candidates, 0.0);
    current_track.assign(truth_ids_.size(), kNone);
    std::int64_t matches = 0;
    for (std::size_t i = 0; i < frame.truth.size(); ++i) {
      if (columns[i] == kNone) continue;
      ++matches;
      const std::int32_t truth = frame.truth[i];
      const std::int32_t track = frame.tracks[columns[i]];
      if (last_track[truth] != kNone && last_track[truth] != track) ++scores.id_switches;
      last_track[truth] = track;
      current_track[truth] = track;
    }
    previous_track.swap(current_track);
    scores.truth_points += static_cast<std::int64_t>(frame.truth.size());
    scores.false_negatives += static_cast<std::int64_t>(frame.truth.size()) - matches;
    scores.false_positives += static_cast<std::int64_t>(frame.tracks.size()) - matches;
  }
  const auto errors =
      static_cast<double>(scores.false_negatives + scores.false_positives + scores.id_switches);
  if (scores.truth_points > 0) {
    scores.mota = 1.0 - errors / static_cast<double>(scores.truth_points);
  } else {
    scores.mota = errors > 0.0 ? -std::numeric_limits<double>::infinity() : 1.0;
  }
}

std::vector<TrackingEvaluation::IdPair> TrackingEvaluation::best_pairs(
    const std::map<IdPair, double>& weights) const {
  std::vector<CandidatePair> candidates;
  candidates.reserve(weights.size());
  for (const auto& [ids, weight] : weights) {
    candidates.push_back({ids.first, ids.second, -weight});
  }
  SparseAssignment assignment;
  const auto columns =
      assignment.solve(static_cast<std::int32_t>(truth_ids_.size()),
                       static_cast<std::int32_t>(track_ids_.size()), candidates, 0.0);
  std::vector<IdPair> pairs;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] != kNone) pairs.emplace_back(static_cast<std::int32_t>(i), columns[i]);
  }
  return pairs;
}

std::vector<IdentityPair> TrackingEvaluation::identity_pairs() const {
  std::map<IdPair, double> similarity;
  for (const Frame& frame : frames_) {
    for (const Pair& pair : frame.pairs) {
      if (pair.similarity < kAcceptedSimilarity) continue;
      similarity[{frame.truth[pair.truth], frame.tracks[pair.track]}] += pair.similarity;
    }
  }
  std::vector<IdentityPair> pairs;
  for (const auto& [truth, track] : best_pairs(similarity)) {
    pairs.push_back({truth_ids_[truth], track_ids_[track]});
  }
  std::ranges::sort(pairs, {}, &IdentityPair::truth_id);
  return pairs;
}

void TrackingEvaluation::score_identities(TrackingScores& scores) const {
  std::map<IdPair, double> frames_together;
  double points = 0.0;
  for (const Frame& frame : frames_) {
    points += static_cast<double>(frame.truth.size() + frame.tracks.size());
    for (const Pair& pair : frame.pairs) {
      if (pair.similarity < kAcceptedSimilarity) continue;
      frames_together[{frame.truth[pair.truth], frame.tracks[pair.track]}] += 1.0;
    }
  }
  double true_positives = 0.0;
  for (const IdPair& pair : best_pairs(frames_together)) true_positives += frames_together[pair];
  // 2 IDTP + IDFP + IDFN is the number of points on both sides.
  scores.idf1 = points > 0.0 ? 2.0 * true_positives / points : 1.0;
}

TrackingEvaluation::IdentityCounts TrackingEvaluation::count_identities() const {
  IdentityCounts counts;
  counts.truth_frames.resize(truth_ids_.size(), 0.0);
  counts.track_frames.resize(track_ids_.size(), 0.0);
  for (const Frame& frame : frames_) {
    std::vector<double> truth_sum(frame.truth.size(), 0.0);
    std::vector<double> track_sum(frame.tracks.size(), 0.0);
    for (const Pair& pair : frame.pairs) {
      truth_sum[pair.truth] += pair.similarity;
      track_sum[pair.track] += pair.similarity;
    }
    for (const Pair& pair : frame.pairs) {
      counts.potential[{frame.truth[pair.truth], frame.tracks[pair.track]}] +=
          pair.similarity / (truth_sum[pair.truth] + track_sum[pair.track] - pair.similarity);
    }
    for (const std::int32_t id : frame.truth) counts.truth_frames[id] += 1.0;
    for (const std::int32_t id : frame.tracks) counts.track_frames[id] += 1.0;
    counts.truth_points += static_cast<double>(frame.truth.size());
    counts.track_points += static_cast<double>(frame.tracks.size());
  }
  return counts;
}

std::vector<std::map<TrackingEvaluation::IdPair, double>> TrackingEvaluation::match_at_thresholds(
    const IdentityCounts& counts) const {
  std::vector<std::map<IdPair, double>> matches(kThresholds);
  SparseAssignment assignment;
  std::vector<CandidatePair> candidates;
  for (const Frame& frame : frames_) {
    candidates.clear();
    std::map<IdPair, double> similarity_of;
    for (const Pair& pair : frame.pairs) {
      const IdPair ids = {frame.truth[pair.truth], frame.tracks[pair.track]};
      const double common = counts.potential.at(ids);
      const double alignment =
          common / (counts.truth_frames[ids.first] + counts.track_frames[ids.second] - common);
      candidates.push_back({pair.truth, pair.track, -alignment * pair.similarity});
      similarity_of[{pair.truth, pair.track}] = pair.similarity;
    }
    const auto columns =
        assignment.solve(static_cast<std::int32_t>(frame.truth.size()),
                         static_cast<std::int32_t>(frame.tracks.size()), candidates, 0.0);
    for (std::size_t i = 0; i < frame.truth.size(); ++i) {
      if (columns[i] == kNone) continue;
      const double similarity = similarity_of[{static_cast<std::int32_t>(i), columns[i]}];
      for (int a = 0; a < kThresholds; ++a) {
        if (similarity < 0.05 * (a + 1) - 1e-12) break;
        matches[a][{frame.truth[i], frame.tracks[columns[i]]}] += 1.0;
      }
    }
  }
  return matches;
}

void TrackingEvaluation::score_hota(TrackingScores& scores) const {
  const IdentityCounts counts = count_identities();
  if (counts.truth_points == 0.0 && counts.track_points == 0.0) {
    scores.hota = scores.detection_accuracy = scores.association_accuracy = 1.0;
    return;
  }
  for (const auto& at_threshold : match_at_thresholds(counts)) {
    double true_positives = 0.0;
    double association = 0.0;
    for (const auto& [ids, count] : at_threshold) {
      true_positives += count;
      association += count * count /
                     (counts.truth_frames[ids.first] + counts.track_frames[ids.second] - count);
    }
    const double detection =
        true_positives / (counts.truth_points + counts.track_points - true_positives);
    if (true_positives > 0.0) association /= true_positives;
    scores.detection_accuracy += detection / kThresholds;
    scores.association_accuracy += association / kThresholds;
    scores.hota += std::sqrt(detection * association) / kThresholds;
  }
}

TrackingScores TrackingEvaluation::scores() const {
  TrackingScores scores;
  scores.frames = static_cast<std::int64_t>(frames_.size());
  scores.truth_ids = static_cast<std::int64_t>(truth_ids_.size());
  scores.track_ids = static_cast<std::int64_t>(track_ids_.size());
  score_clear_mot(scores);
  score_identities(scores);
  score_hota(scores);
  return scores;
}

Result<double> count_nae_pct(std::span<const std::int64_t> true_counts,
                             std::span<const std::int64_t> counted) {
  if (true_counts.empty() || true_counts.size() != counted.size()) {
    return Error{ErrorCode::kInvalidArgument, "the counts are empty or differ in number"};
  }
  double error = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < true_counts.size(); ++i) {
    if (true_counts[i] < 0 || counted[i] < 0) {
      return Error{ErrorCode::kInvalidArgument, "a count is negative"};
    }
    error += std::abs(static_cast<double>(counted[i]) - static_cast<double>(true_counts[i]));
    total += static_cast<double>(true_counts[i]);
  }
  if (total > 0.0) return 100.0 * error / total;
  return error > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

}  // namespace furrow::tracking
