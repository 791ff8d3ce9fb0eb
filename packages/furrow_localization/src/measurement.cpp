#include "furrow_localization/measurement.hpp"

namespace furrow::localization {

std::string_view to_string(FixQuality quality) {
  switch (quality) {
    case FixQuality::kNone:
      return "none";
    case FixQuality::kSingle:
      return "single";
    case FixQuality::kDifferential:
      return "differential";
    case FixQuality::kRtkFloat:
      return "rtk_float";
    case FixQuality::kRtkFixed:
      return "rtk_fixed";
  }
  return "unknown";
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kUsed:
      return "used";
    case Outcome::kUsedLate:
      return "used_late";
    case Outcome::kGated:
      return "gated";
    case Outcome::kRecovered:
      return "recovered";
    case Outcome::kNoFix:
      return "no_fix";
    case Outcome::kDuplicate:
      return "duplicate";
    case Outcome::kTooOld:
      return "too_old";
    case Outcome::kInvalid:
      return "invalid";
    case Outcome::kIgnored:
      return "ignored";
  }
  return "unknown";
}

}  // namespace furrow::localization
