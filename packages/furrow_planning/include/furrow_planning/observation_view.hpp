#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_planning/parameters.hpp"
#include "furrow_planning/speed_profile.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// Final outcome of a target. Every target is reported exactly once, also when it was never
/// planned.
struct TargetOutcome {
  TargetId id = 0;
  Decision decision = Decision::kUnreachable;
  std::int32_t axis = -1;
  Eigen::Vector2d aim_F = Eigen::Vector2d::Zero();  ///< kTreat only
};

/// Plans over a stream of observations (Ahmadi et al. 2024, obsModel). An axis rests at its last
/// stop until it departs for the next one. A stop that departs within commit_s is committed: no
/// later plan changes it. The rolling view keeps its plan and replans only when a target, a crop or
/// an axis has changed. The segment view plans each segment of the row once, in isolation, when all
/// of it has been seen. Not thread-safe.
class ObservationView {
 public:
  virtual ~ObservationView() = default;

  /// Adds a target, or moves and reweighs the one of the same id. Error: not finite, or a negative
  /// weight; the target is then reported as kInvalid. A target that is committed or finished keeps
  /// its outcome.
  virtual Status update(const Target& target) = 0;
  /// Removes a false target. Returns false when it is unknown, committed or finished.
  virtual bool remove(TargetId id) = 0;
  virtual Status update_protected(const ProtectedPlant& plant) = 0;
  virtual bool remove_protected(TargetId id) = 0;

  /// Takes an axis out of service or puts it back. Uncommitted and unfinished stops of a failed
  /// axis go to the others with the next replan. Out-of-range axis: an error.
  virtual Status set_in_service(std::size_t axis, bool in_service) = 0;
  /// Measured rest position of an axis that is not at its last stop.
  virtual Status set_axis_position(std::size_t axis, double position_m) = 0;

  /// Moves the robot. All plants with x < `seen_until_x_m` are taken as seen. A robot that stands
  /// or reverses keeps its plan: the state stays at the furthest point that it reached. If the
  /// measured speed is used, the last speed there stays too. A target that is first given
  /// while it is behind that point, beside one that was treated, is the same plant: kDuplicate.
  /// Error: not finite (the state is then kept).
  virtual Status advance(const RobotState& robot, double seen_until_x_m) = 0;
  /// Updates the plan. Returns whether it was replanned.
  [[nodiscard]] virtual Result<bool> replan() = 0;
  /// Routes from the robot's present position on, committed stops first. Its decisions cover the
  /// targets that are not finished.
  [[nodiscard]] virtual const Plan& plan() const = 0;

  /// From now on plans hold for a robot that drives like this, not at a constant speed. Error: the
  /// segment view, or sprays in passing.
  virtual Status set_speeds(const SpeedProfile& speeds) = 0;
  /// Targets that a plan at these speeds leaves for lack of time, by x. Changes nothing. The span
  /// is valid until the next call. Error: as set_speeds(), or before the first advance.
  [[nodiscard]] virtual Result<std::span<const LeftTarget>> left_at(const SpeedProfile& speeds) = 0;
  /// The robot's x at the last committed spray; where it is now, when there is none.
  [[nodiscard]] virtual double committed_until_x_m() const = 0;

  /// Appends the targets finished since the last call: sprayed or passed.
  virtual void take_outcomes(std::vector<TargetOutcome>& outcomes) = 0;
  /// Distance travelled by each axis over the stops that it has passed.
  [[nodiscard]] virtual const std::vector<double>& travel_m() const = 0;
};

/// By `parameters.view`: "rolling" or "segment". Throws ConfigError as make_route_planner does, and
/// when an axis is not sound.
[[nodiscard]] std::unique_ptr<ObservationView> make_observation_view(
    const PlannerParameters& parameters, std::vector<AxisSpec> axes);

}  // namespace furrow::planning
