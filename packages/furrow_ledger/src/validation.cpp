#include "validation.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::ledger {
namespace {

constexpr double kMaxCoordinate_m = 1e6;
constexpr double kMaxRadius_m = 1.0;
constexpr int kMaxAxes = 64;

bool is_place(const Eigen::Vector2d& p) {
  // Written so that NaN fails.
  return std::abs(p.x()) <= kMaxCoordinate_m && std::abs(p.y()) <= kMaxCoordinate_m;
}
bool is_size(double v) {
  return std::isfinite(v) && v >= 0.0;
}

Error bad(const std::string& what) {
  return {ErrorCode::kInvalidArgument, "ledger: " + what};
}

}  // namespace

Status validate(const field::FieldModel& truth, const RunRecord& record,
                const AccountParameters& parameters) {
  for (const double radius_m : {parameters.accurate_radius_m, parameters.partial_radius_m,
                                parameters.association_radius_m}) {
    if (!(radius_m >= 0.0 && radius_m <= kMaxRadius_m)) {
      return bad("a radius of the account must be in [0, 1] m");
    }
  }
  std::vector<std::int64_t> ids;
  for (const field::Plant& plant : truth.plants) {
    const std::string name = "plant " + std::to_string(plant.id);
    if (!is_place(plant.p_F_m)) return bad(name + " has no usable position");
    if (!is_size(plant.radius_m) || !is_size(plant.area_mm2)) {
      return bad(name + " has a radius or area that is negative or not finite");
    }
    ids.push_back(plant.id);
  }
  std::sort(ids.begin(), ids.end());
  if (const auto twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end()) {
    return bad("two plants have the id " + std::to_string(*twice));
  }
  for (const TrackView& track : record.tracks) {
    if (!is_place(track.p_F_m)) {
      return bad("track " + std::to_string(track.id) + " has no usable position");
    }
  }
  for (const Decision& decision : record.decisions) {
    if (decision.action == Action::kLeave && decision.reason == Reason::kNone) {
      return bad("the decision to leave track " + std::to_string(decision.track_id) +
                 " gives no reason");
    }
  }
  if (record.info.axis_travel_m.size() > kMaxAxes) return bad("the run names more than 64 axes");
  for (const Spray& spray : record.sprays) {
    if (!is_place(spray.p_F_m) || !is_place(spray.aim_F_m)) {
      return bad("a spray of axis " + std::to_string(spray.axis) + " has no usable position");
    }
    if (!(spray.radius_m >= 0.0 && spray.radius_m <= kMaxRadius_m)) {
      return bad("a spray's footprint radius must be in [0, 1] m");
    }
    if (spray.axis < 0 || spray.axis >= kMaxAxes) {
      return bad("a spray names axis " + std::to_string(spray.axis));
    }
  }
  return {};
}

}  // namespace furrow::ledger
