#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_tracking/ground_mask.hpp"
#include "furrow_tracking/observation.hpp"

namespace furrow::tracking {

enum class TrackState : std::uint8_t {
  kTentative,  ///< seen too few times to be believed
  kConfirmed,  ///< believed, and matched in the newest view
  kCoasting,   ///< believed, not matched in the newest view: missed, or out of sight
  kEnded,
};

enum class EndReason : std::uint8_t {
  kNone,      ///< still alive
  kMissed,    ///< not seen often enough where it should have been
  kPassed,    ///< left behind by the robot
  kMerged,    ///< found to be the same plant as another track
  kEvicted,   ///< gave its place to a nearer one: the tracker was full
  kFinished,  ///< alive when the tracker was told that the run is over
};

[[nodiscard]] std::string_view to_string(TrackState state);
[[nodiscard]] std::string_view to_string(EndReason reason);

/// One plant over its views, in the field frame F.
struct Track {
  std::uint64_t id = 0;  ///< from 1, never used twice
  TrackState state = TrackState::kTentative;
  EndReason end_reason = EndReason::kNone;
  bool confirmed = false;  ///< has been confirmed; stays so when it ends
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_F_m2 = Eigen::Matrix2d::Identity();
  double radius_m = 0.0;
  double area_mm2 = 0.0;
  double leaves = 0.0;  ///< growth stage; 0: not known
  double score = 0.0;   ///< mean over its views
  /// P(class | all views, and the place across the rows where that is asked for), by PlantClass.
  std::array<double, kPlantClasses> class_probability = {0.5, 0.5};
  double class_log_odds = 0.0;  ///< of crop to weed, by the views alone
  /// Sum over the views of the log odds of each species against one that no view named; empty
  /// while no view named a species. species_views is the views' summed weight.
  std::vector<float> species_log_odds = {};
  double species_views = 0.0;
  /// P(species | all views) by the caller's species table; the rest to 1 is unknown.
  std::vector<float> species_probability = {};
  std::int32_t views = 0;         ///< matches, the first view included
  std::int32_t whole_views = 0;   ///< of these, those not cut by the image's border
  std::int32_t misses = 0;        ///< in a row, counted only where it should have been seen
  std::int32_t misses_total = 0;  ///< over its life, counted likewise
  Time first_seen = {};
  Time last_seen = {};
  GroundMask footprint = {};  ///< of the newest whole view
  /// Mean distance of recent matches from where the track stood (exponential), in metres.
  double recent_displacement_m = 0.0;
  std::uint64_t merged_into = 0;  ///< the other track's id where end_reason is kMerged

  [[nodiscard]] PlantClass plant_class() const {
    return class_probability[0] > class_probability[1] ? PlantClass::kCrop : PlantClass::kWeed;
  }
};

}  // namespace furrow::tracking
