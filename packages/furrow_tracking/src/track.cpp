#include "furrow_tracking/track.hpp"

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

}  // namespace furrow::tracking
