#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::tracking {

/// A plant, true or tracked, in one frame.
struct LabelledPoint {
  std::int64_t id = 0;
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();
};

struct TrackingScores {
  std::int64_t frames = 0;
  std::int64_t truth_points = 0;
  std::int64_t false_positives = 0;
  std::int64_t false_negatives = 0;
  std::int64_t id_switches = 0;
  std::int64_t truth_ids = 0;
  std::int64_t track_ids = 0;
  /// 1 - (FN + FP + IDSW) / truth points (CLEAR MOT, Bernardin and Stiefelhagen 2008).
  double mota = 0.0;
  /// 2 IDTP / (2 IDTP + IDFP + IDFN) under the best one-to-one pairing of whole identities
  /// (Ristani et al. 2016).
  double idf1 = 0.0;
  /// Mean over thresholds 0.05 ... 0.95 of sqrt(DetA * AssA) (Luiten et al. 2021).
  double hota = 0.0;
  double detection_accuracy = 0.0;    ///< DetA, mean over the thresholds
  double association_accuracy = 0.0;  ///< AssA, mean over the thresholds
};

struct IdentityPair {
  std::int64_t truth_id = 0;
  std::int64_t track_id = 0;
};

/// Collects frames and scores them. Similarity of two points is max(0, 1 - distance /
/// zero_similarity_distance); MOTA and IDF1 accept pairs at similarity 0.5 and more.
class TrackingEvaluation {
 public:
  /// Throws ConfigError when the distance is not positive and finite.
  explicit TrackingEvaluation(double zero_similarity_distance_m);

  /// kInvalidArgument, and nothing added: a position not finite, or an id twice on one side.
  [[nodiscard]] Status add_frame(std::span<const LabelledPoint> truth,
                                 std::span<const LabelledPoint> tracks);
  /// Scores are 1 where there is nothing to find and nothing was claimed.
  [[nodiscard]] TrackingScores scores() const;
  /// Which track stands for which true plant: the one-to-one pairing of whole identities of the
  /// greatest similarity over all frames, by true id. As for IDF1, similarities below 0.5 do not
  /// count; so a plant that was not found is not paired with the track of its neighbour.
  [[nodiscard]] std::vector<IdentityPair> identity_pairs() const;

 private:
  struct Pair {
    std::int32_t truth;
    std::int32_t track;
    double similarity;
  };
  struct Frame {
    std::vector<std::int32_t> truth;   // dense ids
    std::vector<std::int32_t> tracks;  // dense ids
    std::vector<Pair> pairs;           // positions within `truth` and `tracks`
  };
  using IdPair = std::pair<std::int32_t, std::int32_t>;  // dense ids of truth and track
  /// The one-to-one pairs that maximize the sum of their weights.
  [[nodiscard]] std::vector<IdPair> best_pairs(const std::map<IdPair, double>& weights) const;
  void score_clear_mot(TrackingScores& scores) const;
  void score_identities(TrackingScores& scores) const;
  void score_hota(TrackingScores& scores) const;
  /// Frames of each identity, and how far each pair of identities goes together (HOTA's global
  /// alignment before normalization).
  struct IdentityCounts {
    std::vector<double> truth_frames;  // by dense id, as track_frames
    std::vector<double> track_frames;
    std::map<IdPair, double> potential;
    double truth_points = 0.0;
    double track_points = 0.0;
  };
  [[nodiscard]] IdentityCounts count_identities() const;
  /// By threshold, the frames in which two identities are matched.
  [[nodiscard]] std::vector<std::map<IdPair, double>> match_at_thresholds(
      const IdentityCounts& counts) const;

  double zero_similarity_distance_m_;
  std::vector<Frame> frames_;
  std::vector<std::int64_t> truth_ids_;
  std::vector<std::int64_t> track_ids_;
  std::map<std::int64_t, std::int32_t> truth_index_;
  std::map<std::int64_t, std::int32_t> track_index_;
};

/// Normalized absolute error of counts over several stretches of field:
/// sum |counted - true| / sum true, in percent. 0 when nothing is there and nothing counted,
/// infinite when something is counted where nothing is.
/// kInvalidArgument: the spans differ in length, are empty, or hold a negative count.
[[nodiscard]] Result<double> count_nae_pct(std::span<const std::int64_t> true_counts,
                                           std::span<const std::int64_t> counted);

}  // namespace furrow::tracking
