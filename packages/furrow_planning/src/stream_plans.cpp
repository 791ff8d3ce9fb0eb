// The plans that a StreamPlanner makes of what it knows, and the speeds that they are for.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "stream_planner.hpp"

namespace furrow::planning {
namespace {

constexpr double kDrift_m = 0.002;     ///< sideways drift of the robot that asks for a new plan
constexpr double kSpeedChange = 0.01;  ///< change of speed that does

Error invalid(std::string message) {
  return {ErrorCode::kInvalidArgument, std::move(message)};
}

}  // namespace

bool StreamPlanner::may_plan(const Record& record) const {
  if (record.phase != Phase::kWaiting) {
    return false;
  }
  return !segments_ || (!record.segment_planned && record.target.p_F.x() < planned_until_x_m_);
}

bool StreamPlanner::collect() {
  if (segments_) {
    const double length_m = parameters_.segment_length_m;
    bool complete = false;
    while (planned_until_x_m_ + length_m <= seen_until_x_m_) {
      planned_until_x_m_ += length_m;
      complete = true;
    }
    bool failed_over = false;
    for (const Record& record : records_) {
      failed_over = failed_over ||
                    (record.phase == Phase::kWaiting && record.decision == Decision::kAxisFault);
    }
    if (!complete && !failed_over) {
      return false;
    }
  }
  targets_.clear();
  target_records_.clear();
  for (std::size_t i = 0; i < records_.size(); ++i) {
    if (may_plan(records_[i])) {
      targets_.push_back(records_[i].target);
      target_records_.push_back(i);
    }
  }
  states_.clear();
  for (const AxisRecord& axis : axes_) {
    AxisState state = axis.rest;
    if (axis.committed_count > 0) {
      const Stop& last = axis.committed[axis.committed_count - 1].stop;
      state = {.position_m = last.position_m,
               .free_from_x_m = last.robot_x_m,
               .in_service = true,
               .after_spray = true};
    }
    state.in_service = axis.in_service;
    states_.push_back(state);
  }
  return true;
}

PlanningProblem StreamPlanner::problem() const {
  return {.targets = targets_,
          .protected_plants = protected_,
          .axes = specs_,
          .states = states_,
          .robot = robot_,
          .speeds = speeds_ ? &*speeds_ : nullptr};
}

Result<bool> StreamPlanner::replan() {
  if (!placed_) {
    return Error{ErrorCode::kUnavailable, "the robot's state has not been given yet"};
  }
  const double speed_mps = planning_speed_mps();  // not in use where the speeds are given
  const bool moved = std::abs(speed_mps - planned_speed_mps_) > kSpeedChange * planned_speed_mps_ ||
                     std::abs(robot_.y_m - planned_y_m_) > kDrift_m;
  if (!segments_ && !changed_ && !moved) {
    return false;
  }
  if (!collect()) {
    return false;
  }
  const PlanningProblem present = problem();
  if (Status status = planner_->plan(present, fresh_); !status) {
    return status.error();
  }
  if (Status status = checker_.check(present, fresh_); !status) {
    return status.error();
  }
  planned_speed_mps_ = speed_mps;
  planned_y_m_ = robot_.y_m;
  changed_ = false;
  merge();
  return true;
}

void StreamPlanner::merge() {
  for (std::size_t i = 0; i < target_records_.size(); ++i) {
    Record& record = records_[target_records_[i]];
    record.decision = fresh_.decisions[i].decision;
    record.axis = fresh_.decisions[i].axis;
    record.segment_planned = segments_;
  }
  plan_.clear(axes_.size());
  plan_.weight = fresh_.weight;
  plan_.weight_bound = fresh_.weight_bound;
  plan_.travel_m = fresh_.travel_m;
  const auto append = [this](std::size_t axis, Stop stop, std::span<const TargetId> ids) {
    stop.first_target = static_cast<std::uint32_t>(plan_.treated.size());
    plan_.treated.insert(plan_.treated.end(), ids.begin(), ids.end());
    plan_.routes[axis].push_back(stop);
  };
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    for (std::size_t i = 0; i < axes_[a].committed_count; ++i) {
      append(a, axes_[a].committed[i].stop, axes_[a].committed[i].ids);
    }
    for (const Stop& stop : fresh_.routes[a]) {
      append(a, stop, fresh_.targets_of(stop));
    }
    if (segments_) {
      for (std::size_t s = axes_[a].committed_count; s < plan_.routes[a].size(); ++s) {
        commit(axes_[a], plan_.routes[a][s]);
      }
    }
  }
  for (const Record& record : records_) {
    if (record.phase == Phase::kCommitted) {
      plan_.decisions.push_back({record.target.id, Decision::kTreat, record.axis});
    } else if (record.phase == Phase::kWaiting) {
      plan_.decisions.push_back({record.target.id, record.decision, record.axis});
    }
  }
}

Status StreamPlanner::may_change_speed() const {
  if (segments_) {
    return invalid("the segment view plans at a constant speed");
  }
  if (parameters_.fire_while_moving) {
    return invalid("sprays in passing are planned at a constant speed");
  }
  return {};
}

Status StreamPlanner::set_speeds(const SpeedProfile& speeds) {
  if (Status status = may_change_speed(); !status) {
    return status;
  }
  speeds_ = speeds;
  changed_ = true;
  return {};
}

Result<std::span<const LeftTarget>> StreamPlanner::left_at(const SpeedProfile& speeds) {
  if (Status status = may_change_speed(); !status) {
    return status.error();
  }
  if (!placed_) {
    return Error{ErrorCode::kUnavailable, "the robot's state has not been given yet"};
  }
  (void)collect();
  PlanningProblem trial = problem();
  trial.speeds = &speeds;
  if (Status status = planner_->plan(trial, trial_); !status) {
    return status.error();
  }
  left_.clear();
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (trial_.decisions[i].decision == Decision::kUnreachable) {
      left_.push_back({targets_[i].p_F.x(), targets_[i].weight});
    }
  }
  std::ranges::sort(left_, {}, &LeftTarget::x_m);
  return std::span<const LeftTarget>(left_);
}

double StreamPlanner::committed_until_x_m() const {
  double until_x_m = robot_.x_m;
  for (const AxisRecord& axis : axes_) {
    if (axis.committed_count > 0) {
      until_x_m = std::max(until_x_m, axis.committed[axis.committed_count - 1].stop.robot_x_m);
    }
  }
  return until_x_m;
}

}  // namespace furrow::planning
