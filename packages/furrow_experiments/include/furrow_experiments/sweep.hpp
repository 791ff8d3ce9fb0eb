#pragma once

#include <string>
#include <vector>

#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"

namespace furrow::experiments {

/// What if one figure of the machine were another: all else stays as it is.
struct SweepPoint {
  std::string parameter;  ///< "speed_mps", "axes", "axis_velocity_mps", "omega"
  double value = 0.0;
  EvaluationRow row;
};

/// Rolling view of one field case over each parameter in turn, every planner asked for. Errors and
/// exceptions: as drive_all.
[[nodiscard]] Result<std::vector<SweepPoint>> run_sweeps(
    const FieldCase& field, const std::vector<PlannerChoice>& planners, const Variant& base,
    const SamplingParameters& sampling, std::size_t threads, const Progress& progress = {});

}  // namespace furrow::experiments
