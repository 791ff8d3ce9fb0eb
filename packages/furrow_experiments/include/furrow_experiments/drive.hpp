#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_experiments/field_case.hpp"
#include "furrow_experiments/setup.hpp"
#include "furrow_planning/observation_view.hpp"
#include "furrow_planning/parameters.hpp"

namespace furrow::experiments {

/// One spray that was carried out.
struct Spray {
  std::size_t axis = 0;
  Eigen::Vector2d aim_F = Eigen::Vector2d::Zero();
  std::vector<planning::TargetId> treated;
};

/// How often the calling thread has asked for memory so far.
using AllocationCount = std::function<std::uint64_t()>;

struct DriveResult {
  std::vector<planning::TargetOutcome> outcomes;  ///< one for each weed, by id
  std::vector<Spray> sprays;                      ///< by axis, then along its way
  std::vector<double> travel_m;                   ///< of each axis
  std::vector<double> replan_us;  ///< of each frame that was planned; by the clock, not repeatable
  std::vector<std::uint64_t> replan_allocations;  ///< of the same frames; empty when not counted
};

/// Drives over a field at the planner's nominal speed without drawing anything: at each frame the
/// view gets the plants up to look_ahead_m before the first axis, and plans. The robot starts where
/// it sees nothing yet and stops behind the last plant. Error: the view's, a plan that its checker
/// refused, or sprays that check_sprays refuses. Throws ConfigError as make_observation_view.
[[nodiscard]] Result<DriveResult> drive(const FieldTargets& field,
                                        const planning::PlannerParameters& planner,
                                        const SetupParameters& setup,
                                        const AllocationCount& allocations = {});

/// Where the robot of drive() starts.
[[nodiscard]] double start_x_m(const SetupParameters& setup);

}  // namespace furrow::experiments
