#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_components/georeference.hpp"
#include "furrow_components/observation_conversion.hpp"
#include "furrow_evaluation/sensing_log.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_localization/pose_filter.hpp"
#include "furrow_tracking/metrics.hpp"
#include "furrow_tracking/tracker.hpp"

namespace furrow::evaluation {

/// Which sensors the pose is made of.
enum class PoseSource : std::uint8_t {
  kOdometry,  ///< wheels and gyroscope, from the true start on
  kGnss,      ///< GNSS alone
  kFused,
  kTruth,  ///< where the robot truly is, for comparison
};
[[nodiscard]] std::string_view to_string(PoseSource source);

struct ReplayOptions {
  PoseSource pose = PoseSource::kFused;
  localization::PoseFilterParameters filter;
  components::GeoreferenceParameters georeference;
  components::ObservationParameters observation;
  tracking::TrackerParameters tracker;
};

struct PlantCounts {
  std::int64_t all = 0;      ///< that stand in the field
  std::int64_t visible = 0;  ///< of these, those that an image shows kLeastVisible_px of or more
  std::int64_t counted = 0;  ///< confirmed tracks within the row's length
};

/// How well the plants of one log were tracked.
struct ReplayResult {
  /// Frame by frame, in the robot's own frame: what localization drifts does not count here. A
  /// track stands for a plant within 25 mm.
  tracking::TrackingScores scores;
  PlantCounts crops;
  PlantCounts weeds;
  std::int64_t frames_without_pose = 0;
  /// Of the last position of each plant's own track (TrackingEvaluation::identity_pairs) from the
  /// plant, in the field frame.
  std::vector<double> stem_errors_mm;
  std::vector<double> position_errors_mm;  ///< of the base's pose at each frame
  std::vector<double> heading_errors_rad;
  std::vector<tracking::Track> tracks;  ///< all that were confirmed
};

/// Throws ConfigError for parameters out of range.
[[nodiscard]] ReplayResult replay_tracking(const SensingLog& log,
                                           const geometry::CameraModel& camera,
                                           const ReplayOptions& options);

}  // namespace furrow::evaluation
