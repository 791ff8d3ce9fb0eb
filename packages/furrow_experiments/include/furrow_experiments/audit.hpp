#pragma once

#include <span>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_experiments/drive.hpp"

namespace furrow::experiments {

/// Checks the sprays of a whole drive, from the definitions alone:
/// - each weed is treated once and within the footprint;
/// - each spray is within its axis's span;
/// - an axis has enough time between two sprays (where nozzles fire in passing: for the move);
/// - no spray is within the protection zone of a crop.
/// The Error names the first check that fails.
[[nodiscard]] Status check_sprays(const FieldTargets& field, std::span<const Spray> sprays,
                                  const planning::PlannerParameters& planner,
                                  const SetupParameters& setup);

}  // namespace furrow::experiments
