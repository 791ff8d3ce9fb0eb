#include "furrow_planning/types.hpp"

namespace furrow::planning {

std::string_view to_string(Decision decision) {
  switch (decision) {
    case Decision::kTreat:
      return "treat";
    case Decision::kUnreachable:
      return "unreachable";
    case Decision::kLowPriority:
      return "low_priority";
    case Decision::kProtectedCrop:
      return "protected_crop";
    case Decision::kOutside:
      return "outside";
    case Decision::kBehind:
      return "behind";
    case Decision::kInvalid:
      return "invalid";
    case Decision::kDuplicate:
      return "duplicate";
    case Decision::kAxisFault:
      return "fault";
  }
  return "unknown";
}

void Plan::clear(std::size_t axes) {
  routes.resize(axes);
  for (auto& route : routes) {
    route.clear();
  }
  treated.clear();
  decisions.clear();
  weight = 0.0;
  weight_bound = 0.0;
  travel_m = 0.0;
}

}  // namespace furrow::planning
