#pragma once

#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_planning/harmfulness.hpp"
#include "furrow_planning/observation_view.hpp"
#include "furrow_planning/speed_governor.hpp"

namespace furrow::components {

struct PlannerComponentParameters {
  std::string tool_file;
  std::string species_file;
  double crop_threshold = 0.5;
  double unsure_threshold = 0.3;
  bool treat_unconfirmed = false;
  double max_pose_age_s = 0.2;
  double max_tracks_age_s = 2.0;
  double heartbeat_rate_hz = 50.0;
  bool govern_speed = false;
  planning::PlannerParameters planner;
  planning::HarmfulnessParameters harmfulness;
  planning::SpeedGovernorParameters governor;

  void visit(ParameterVisitor& v);
};

/// Replaces the lists of species in `harmfulness` by the weeds of `species_file`, if it is set.
/// Throws ConfigError: the file cannot be read, or parameters contradict each other.
[[nodiscard]] PlannerComponentParameters completed(PlannerComponentParameters parameters);

}  // namespace furrow::components
