#include "furrow_localization/pose_estimator.hpp"

namespace furrow::localization {

void SensorCounts::count(Outcome outcome) {
  switch (outcome) {
    case Outcome::kUsedLate:
      ++late;
      ++used;
      return;
    case Outcome::kRecovered:
      ++recovered;
      ++used;
      return;
    case Outcome::kUsed:
      ++used;
      return;
    case Outcome::kGated:
      ++gated;
      return;
    case Outcome::kNoFix:
      ++no_fix;
      return;
    case Outcome::kDuplicate:
      ++duplicate;
      return;
    case Outcome::kTooOld:
      ++too_old;
      return;
    case Outcome::kInvalid:
      ++invalid;
      return;
    case Outcome::kIgnored:
      ++ignored;
      return;
  }
}

}  // namespace furrow::localization
