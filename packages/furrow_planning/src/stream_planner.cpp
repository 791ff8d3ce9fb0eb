#include "stream_planner.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "furrow_planning/kinematics.hpp"

namespace furrow::planning {
namespace {

constexpr double kRememberBehind_m = 3.0;  ///< finished targets are known this long
constexpr double kForgetEvery_m = 0.5;
/// Slower than this a robot is about to stand, or begins to drive: plans hold for its last speed.
constexpr double kStandingSpeed_mps = 0.02;
/// A target that is first seen while the robot is behind, this near to a treated one, is the same.
constexpr double kSamePlant_m = 0.02;
constexpr double kMoved_m = 1e-4;  ///< a target that moved less, and kept its weight, did not

Error invalid(std::string message) {
  return {ErrorCode::kInvalidArgument, std::move(message)};
}

template <class Items>
auto position(Items& items, TargetId id) {
  return std::lower_bound(items.begin(), items.end(), id, [](const auto& item, TargetId value) {
    if constexpr (requires { item.target; }) {
      return item.target.id < value;
    } else {
      return item.id < value;
    }
  });
}

}  // namespace

StreamPlanner::StreamPlanner(const PlannerParameters& parameters, std::vector<AxisSpec> axes)
    : parameters_(parameters),
      segments_(parameters.view == "segment"),
      planner_(make_route_planner(parameters)),
      checker_(parameters),
      specs_(std::move(axes)) {
  if (specs_.empty()) {
    throw ConfigError("there is no axis to plan for");
  }
  for (const AxisSpec& spec : specs_) {
    const Transition sound(parameters, parameters.speed_mps, spec);
    if (!std::isfinite(spec.offset_x_m) || !(spec.lower_m < spec.upper_m) ||
        !std::isfinite(spec.upper_m - spec.lower_m)) {
      throw ConfigError("an axis's offset or span is not sound");
    }
    const double middle_m = 0.5 * (spec.lower_m + spec.upper_m);
    axes_.push_back({.spec = spec, .rest = {.position_m = middle_m}});
  }
  // Before the first target the heads stand apart, each in the middle of its share of the span.
  const double share = 1.0 / static_cast<double>(axes_.size());
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const AxisSpec& spec = axes_[a].spec;
    axes_[a].rest.position_m =
        spec.lower_m + (spec.upper_m - spec.lower_m) * share * (static_cast<double>(a) + 0.5);
  }
  travel_m_.assign(axes_.size(), 0.0);
  plan_.clear(axes_.size());
}

StreamPlanner::Record* StreamPlanner::find(TargetId id) {
  const auto it = position(records_, id);
  return it != records_.end() && it->target.id == id ? &*it : nullptr;
}

double StreamPlanner::planning_speed_mps() const {
  return parameters_.speed_source == "measured" ? robot_.speed_mps : parameters_.speed_mps;
}

Status StreamPlanner::update(const Target& target) {
  const auto it = position(records_, target.id);
  const bool known = it != records_.end() && it->target.id == target.id;
  if (!target.p_F.allFinite() || !std::isfinite(target.weight) || target.weight < 0.0) {
    if (!known) {
      outcomes_.push_back({.id = target.id, .decision = Decision::kInvalid});
    }
    return invalid("target " + std::to_string(target.id) +
                   " has a position or weight that is not finite, or a negative weight");
  }
  if (!known && treated_before(target)) {
    outcomes_.push_back({.id = target.id, .decision = Decision::kDuplicate});
    return {};
  }
  if (!known) {
    if (records_.size() >= static_cast<std::size_t>(parameters_.max_targets)) {
      outcomes_.push_back({.id = target.id, .decision = Decision::kInvalid});
      return invalid("there are more targets than max_targets");
    }
    records_.insert(it, Record{.target = target});
    changed_ = true;
    return {};
  }
  if (it->phase != Phase::kWaiting) {
    return {};
  }
  changed_ = changed_ || (it->target.p_F - target.p_F).norm() > kMoved_m ||
             it->target.weight != target.weight;
  if (changed_) {
    it->target = target;
  }
  return {};
}

// A robot that reversed sees plants again that were treated; the tracker may have forgotten them.
bool StreamPlanner::treated_before(const Target& target) const {
  return behind_m_ > 0.0 && std::ranges::any_of(records_, [&](const Record& record) {
           const bool treated =
               record.phase == Phase::kCommitted ||
               (record.phase == Phase::kFinished && record.decision == Decision::kTreat);
           return treated && (record.target.p_F - target.p_F).norm() < kSamePlant_m;
         });
}

bool StreamPlanner::remove(TargetId id) {
  Record* record = find(id);
  if (record == nullptr || record->phase != Phase::kWaiting) {
    return false;
  }
  records_.erase(records_.begin() + (record - records_.data()));
  changed_ = true;
  return true;
}

Status StreamPlanner::update_protected(const ProtectedPlant& plant) {
  if (!plant.p_F.allFinite() || !std::isfinite(plant.zone_m) || plant.zone_m < 0.0) {
    return invalid("protected plant " + std::to_string(plant.id) +
                   " has a position or zone that is not sound");
  }
  const auto it = position(protected_, plant.id);
  if (it != protected_.end() && it->id == plant.id) {
    if ((it->p_F - plant.p_F).norm() <= kMoved_m && it->zone_m == plant.zone_m) {
      return {};
    }
    *it = plant;
  } else {
    protected_.insert(it, plant);
  }
  changed_ = true;
  return {};
}

bool StreamPlanner::remove_protected(TargetId id) {
  const auto it = position(protected_, id);
  if (it == protected_.end() || it->id != id) {
    return false;
  }
  protected_.erase(it);
  changed_ = true;
  return true;
}

Status StreamPlanner::set_in_service(std::size_t axis, bool in_service) {
  if (axis >= axes_.size()) {
    return Error{ErrorCode::kOutOfRange, "there is no axis " + std::to_string(axis)};
  }
  if (axes_[axis].in_service == in_service) {
    return {};
  }
  axes_[axis].in_service = in_service;
  axes_[axis].rest.free_from_x_m = std::max(axes_[axis].rest.free_from_x_m, robot_.x_m);
  changed_ = true;
  if (!in_service) {
    drop_stops(axes_[axis]);
  }
  if (segments_) {
    // What was planned for the others is planned again, together with what the axis leaves.
    for (AxisRecord& other : axes_) {
      drop_stops(other);
    }
    for (Record& record : records_) {
      record.segment_planned = false;
    }
  }
  return {};
}

Status StreamPlanner::set_axis_position(std::size_t axis, double position_m) {
  if (axis >= axes_.size()) {
    return Error{ErrorCode::kOutOfRange, "there is no axis " + std::to_string(axis)};
  }
  if (!std::isfinite(position_m)) {
    return invalid("the position of axis " + std::to_string(axis) + " is not finite");
  }
  AxisState& rest = axes_[axis].rest;
  if (std::abs(rest.position_m - position_m) > kMoved_m) {
    rest.position_m = position_m;
    changed_ = true;
  }
  return {};
}

Status StreamPlanner::advance(const RobotState& robot, double seen_until_x_m) {
  if (!std::isfinite(robot.x_m) || !std::isfinite(robot.y_m) || !std::isfinite(seen_until_x_m)) {
    return invalid("the robot's state is not finite");
  }
  const bool onward = !placed_ || robot.x_m >= robot_.x_m;
  behind_m_ = onward ? 0.0 : robot_.x_m - robot.x_m;
  seen_until_x_m_ = std::max(seen_until_x_m_, seen_until_x_m);
  if (!onward) {
    return {};
  }
  if (!placed_) {
    for (AxisRecord& axis : axes_) {
      axis.rest.free_from_x_m = robot.x_m;
    }
    planned_until_x_m_ =
        std::floor(robot.x_m / parameters_.segment_length_m) * parameters_.segment_length_m;
    forgotten_x_m_ = robot.x_m;
  }
  const double known_speed_mps = placed_ ? robot_.speed_mps : parameters_.speed_mps;
  robot_ = robot;
  if (!(std::isfinite(robot.speed_mps) && robot.speed_mps > kStandingSpeed_mps)) {
    robot_.speed_mps = known_speed_mps;
  }
  placed_ = true;
  commit_due_stops();
  pass_stops();
  finish_passed_targets();
  forget_old();
  return {};
}

void StreamPlanner::commit_due_stops() {
  const double due_x_m = speeds_ ? speeds_->x_m(speeds_->time_s(robot_.x_m) + parameters_.commit_s)
                                 : robot_.x_m + parameters_.commit_s * planning_speed_mps();
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    AxisRecord& axis = axes_[a];
    for (std::size_t s = axis.committed_count; s < plan_.routes[a].size(); ++s) {
      const Stop& stop = plan_.routes[a][s];
      if (stop.depart_x_m > due_x_m) {
        break;
      }
      commit(axis, stop);
    }
  }
}

void StreamPlanner::commit(AxisRecord& axis, const Stop& stop) {
  if (axis.committed_count == axis.committed.size()) {
    axis.committed.emplace_back();
  }
  Committed& entry = axis.committed[axis.committed_count++];
  entry.stop = stop;
  entry.ids.assign(plan_.targets_of(stop).begin(), plan_.targets_of(stop).end());
  for (const TargetId id : entry.ids) {
    if (Record* record = find(id); record != nullptr) {
      record->phase = Phase::kCommitted;
      record->axis = static_cast<std::int32_t>(&axis - axes_.data());
      record->aim_F = stop.aim_F;
    }
  }
}

void StreamPlanner::pass_stops() {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    AxisRecord& axis = axes_[a];
    std::size_t passed = 0;
    while (passed < axis.committed_count && axis.committed[passed].stop.robot_x_m <= robot_.x_m) {
      const Committed& entry = axis.committed[passed];
      travel_m_[a] += std::abs(entry.stop.position_m - axis.rest.position_m);
      axis.rest = {.position_m = entry.stop.position_m,
                   .free_from_x_m = entry.stop.robot_x_m,
                   .in_service = true,
                   .after_spray = true};
      for (const TargetId id : entry.ids) {
        if (Record* record = find(id); record != nullptr) {
          finish(*record, Decision::kTreat);
        }
      }
      ++passed;
    }
    if (passed > 0) {
      const auto first = axis.committed.begin();
      std::rotate(first, first + static_cast<std::ptrdiff_t>(passed),
                  first + static_cast<std::ptrdiff_t>(axis.committed_count));
      axis.committed_count -= passed;
      auto& route = plan_.routes[a];
      route.erase(route.begin(), route.begin() + static_cast<std::ptrdiff_t>(passed));
    }
  }
}

void StreamPlanner::finish(Record& record, Decision decision) {
  record.phase = Phase::kFinished;
  record.decision = decision;
  TargetOutcome outcome{.id = record.target.id, .decision = decision};
  if (decision == Decision::kTreat) {
    outcome.axis = record.axis;
    outcome.aim_F = record.aim_F;
  }
  outcomes_.push_back(outcome);
}

void StreamPlanner::finish_passed_targets() {
  double rear_m = specs_.front().offset_x_m;
  for (const AxisSpec& spec : specs_) {
    rear_m = std::min(rear_m, spec.offset_x_m);
  }
  // An aim may lie ahead of its stem by a footprint.
  const double passed_x_m = robot_.x_m + rear_m - parameters_.footprint_radius_m;
  for (Record& record : records_) {
    if (record.phase == Phase::kWaiting && record.target.p_F.x() < passed_x_m) {
      finish(record,
             record.decision == Decision::kTreat ? Decision::kUnreachable : record.decision);
    }
  }
}

void StreamPlanner::drop_stops(AxisRecord& axis) {
  for (std::size_t i = 0; i < axis.committed_count; ++i) {
    for (const TargetId id : axis.committed[i].ids) {
      if (Record* record = find(id); record != nullptr) {
        record->phase = Phase::kWaiting;
        record->decision = Decision::kAxisFault;
      }
    }
  }
  axis.committed_count = 0;
  plan_.routes[static_cast<std::size_t>(&axis - axes_.data())].clear();
}

void StreamPlanner::forget_old() {
  if (robot_.x_m < forgotten_x_m_ + kForgetEvery_m) {
    return;
  }
  forgotten_x_m_ = robot_.x_m;
  const double old_x_m = robot_.x_m - kRememberBehind_m;
  std::erase_if(records_, [&](const Record& record) {
    return record.phase == Phase::kFinished && record.target.p_F.x() < old_x_m;
  });
  std::erase_if(protected_, [&](const ProtectedPlant& plant) { return plant.p_F.x() < old_x_m; });
}

void StreamPlanner::take_outcomes(std::vector<TargetOutcome>& outcomes) {
  outcomes.insert(outcomes.end(), outcomes_.begin(), outcomes_.end());
  outcomes_.clear();
}

std::unique_ptr<ObservationView> make_observation_view(const PlannerParameters& parameters,
                                                       std::vector<AxisSpec> axes) {
  if (parameters.view != "rolling" && parameters.view != "segment") {
    throw ConfigError("view is neither rolling nor segment");
  }
  return std::make_unique<StreamPlanner>(parameters, std::move(axes));
}

}  // namespace furrow::planning
