#pragma once

#include <span>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_experiments/drive.hpp"

namespace furrow::experiments {

/// Checks what was carried out over a whole drive, from the definitions alone: each weed treated
/// once and within the footprint, sprays within their axis's span, enough time between two sprays
/// of an axis (only the move itself where nozzles may fire in passing), no spray within the
/// protection zone of a crop. The Error names the first that fails.
[[nodiscard]] Status check_sprays(const FieldTargets& field, std::span<const Spray> sprays,
                                  const planning::PlannerParameters& planner,
                                  const SetupParameters& setup);

}  // namespace furrow::experiments
