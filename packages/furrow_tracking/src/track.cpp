#include "furrow_tracking/track.hpp"

#include <algorithm>

namespace furrow::tracking {

std::string_view to_string(PlantClass plant_class) {
  return plant_class == PlantClass::kCrop ? "crop" : "weed";
}

std::string_view to_string(TrackState state) {
  switch (state) {
    case TrackState::kTentative:
      return "tentative";
    case TrackState::kConfirmed:
      return "confirmed";
    case TrackState::kCoasting:
      return "coasting";
    case TrackState::kEnded:
      return "ended";
  }
  return "unknown";
}

std::string_view to_string(EndReason reason) {
  switch (reason) {
    case EndReason::kNone:
      return "none";
    case EndReason::kMissed:
      return "missed";
    case EndReason::kPassed:
      return "passed";
    case EndReason::kMerged:
      return "merged";
    case EndReason::kEvicted:
      return "evicted";
    case EndReason::kFinished:
      return "finished";
  }
  return "unknown";
}

int Track::species() const {
  const auto best = std::max_element(species_probability.begin(), species_probability.end());
  if (best == species_probability.end() || !(*best > 0.0F)) return -1;
  return static_cast<int>(best - species_probability.begin());
}

}  // namespace furrow::tracking
