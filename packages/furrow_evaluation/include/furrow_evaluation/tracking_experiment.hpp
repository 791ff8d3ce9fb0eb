#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_evaluation/tracking_replay.hpp"

namespace furrow::evaluation {

/// Rendered rows from low to high density, each seen once, and tracked by each association with the
/// pose of each set of sensors.
struct TrackingExperiment {
  std::vector<std::string> fields = {"cn20_like", "sb20_s1_like", "sb20_s2_like", "sb21_s1_like",
                                     "sb21_s2_like"};
  std::vector<std::string> associations = {"dynamic_radius", "fixed_radius", "iou"};
  std::vector<PoseSource> poses = {PoseSource::kOdometry, PoseSource::kGnss, PoseSource::kFused};
  double length_m = 10.0;
  std::int64_t seeds = 1;
  std::uint64_t first_seed = 1;
  int threads = 2;
  std::vector<std::string> settings;
  ReplayOptions replay;  ///< pose and association are set by the rows
};

/// Over the seeds of one field, or of all fields ("all").
struct TrackingRow {
  std::string field;
  std::string association;
  std::string localization;
  /// Of counts, against the plants that an image shows components::kLeastVisible_px of or more,
  /// which are those that a person could mark; and against all that stand in the field.
  double nae_crop_pct = 0.0;
  double nae_weed_pct = 0.0;
  double nae_crop_all_pct = 0.0;
  double nae_weed_all_pct = 0.0;
  double mota = 0.0;
  double idf1 = 0.0;
  double hota = 0.0;
  std::int64_t id_switches = 0;
  std::int64_t plants = 0;
  std::int64_t plants_visible = 0;
  std::int64_t plants_located = 0;  ///< that have a track of their own: whose stems are compared
  double stem_p50_mm = 0.0;
  double stem_p95_mm = 0.0;
  double pose_rms_mm = 0.0;
  double heading_rms_deg = 0.0;
  std::int64_t frames = 0;
  std::int64_t frames_without_pose = 0;
};

/// The parameters of the shipped tracker and localization (params/components). Throws ConfigError.
[[nodiscard]] ReplayOptions shipped_replay_options();

using ShareDone = std::function<void(double)>;

/// Throws ConfigError for what is asked wrongly, std::runtime_error when a run fails.
[[nodiscard]] std::vector<TrackingRow> run(const TrackingExperiment& experiment,
                                           const ShareDone& progress);

[[nodiscard]] std::string to_table(const std::vector<TrackingRow>& rows);
[[nodiscard]] std::string to_json(const TrackingExperiment& experiment,
                                  const std::vector<TrackingRow>& rows, std::string_view version);
[[nodiscard]] std::string to_html(const TrackingExperiment& experiment,
                                  const std::vector<TrackingRow>& rows, std::string_view version);

}  // namespace furrow::evaluation
