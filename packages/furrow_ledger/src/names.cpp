#include <array>

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {
namespace {

constexpr std::array<std::string_view, kReasonCount> kReasonNames = {
    "none",           "undetected",  "unconfirmed", "misclassified", "low_priority",
    "protected_crop", "unreachable", "stale",       "outside",       "fault",
    "placement",      "end_of_run",  "inactive",    "unsure"};

}  // namespace

std::string_view to_string(Reason reason) {
  return kReasonNames.at(static_cast<std::size_t>(reason));
}

std::optional<Reason> reason_from_string(std::string_view name) {
  for (std::size_t i = 0; i < kReasonNames.size(); ++i) {
    if (kReasonNames[i] == name) return static_cast<Reason>(i);
  }
  return std::nullopt;
}

bool is_vision_loss(Reason reason) {
  return reason == Reason::kUndetected || reason == Reason::kUnconfirmed ||
         reason == Reason::kMisclassified || reason == Reason::kUnsure;
}

std::string_view to_string(Action action) {
  switch (action) {
    case Action::kNone:
      return "none";
    case Action::kTreat:
      return "treat";
    case Action::kLeave:
      return "leave";
  }
  return "none";
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kAccurate:
      return "accurate";
    case Outcome::kPartial:
      return "partial";
    case Outcome::kMissed:
      return "missed";
    case Outcome::kSpared:
      return "spared";
    case Outcome::kHit:
      return "hit";
  }
  return "missed";
}

void AccountParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "accurate_radius_m",
           .unit = "m",
           .description = "A weed is treated accurately up to this distance from a spray's centre",
           .min = 0.0,
           .max = 0.5},
          accurate_radius_m);
  v.visit({.name = "partial_radius_m",
           .unit = "m",
           .description = "A weed is treated in part up to this distance: the footprint's radius",
           .min = 0.0,
           .max = 0.5},
          partial_radius_m);
  v.visit({.name = "association_radius_m",
           .unit = "m",
           .description = "A track may stand for a plant up to this distance from its stem",
           .min = 0.0,
           .max = 0.5},
          association_radius_m);
}

}  // namespace furrow::ledger
