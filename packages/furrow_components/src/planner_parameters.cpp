#include "planner_parameters.hpp"

#include "furrow_components/field_source.hpp"

namespace furrow::components {

void PlannerComponentParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
  v.visit({.name = "species_file",
           .description = "table of species with their factors; empty: the lists below"},
          species_file);
  v.visit({.name = "crop_threshold",
           .description = "tracks with at least this crop probability are crop",
           .min = 0.0,
           .max = 1.0},
          crop_threshold);
  v.visit({.name = "unsure_threshold",
           .description = "tracks from this crop probability up to crop_threshold are unsure: not "
                          "treated, and protected like crops",
           .min = 0.0,
           .max = 1.0},
          unsure_threshold);
  v.visit({.name = "treat_unconfirmed",
           .description = "also plan for weeds whose track is not confirmed: fewer missed weeds, "
                          "more sprays on bare soil"},
          treat_unconfirmed);
  v.visit({.name = "max_pose_age_s",
           .unit = "s",
           .description = "largest age of the odometry; nothing is planned with an older one",
           .min = 0.01,
           .max = 10.0},
          max_pose_age_s);
  v.visit({.name = "max_tracks_age_s",
           .unit = "s",
           .description = "tracks whose newest image is older are stale; their weeds are not "
                          "treated until they are seen again",
           .min = 0.05,
           .max = 60.0},
          max_tracks_age_s);
  v.visit({.name = "heartbeat_rate_hz",
           .unit = "Hz",
           .description = "rate of planner/heartbeat",
           .min = 1.0,
           .max = 1000.0},
          heartbeat_rate_hz);
  v.visit({.name = "govern_speed",
           .description = "request a robot speed at which the axes reach the weeds ahead, at most "
                          "speed_mps, and plan for that speed"},
          govern_speed);
  planner.visit(v);
  PrefixedVisitor harmfulness_visitor(v, "harmfulness_");
  harmfulness.visit(harmfulness_visitor);
  PrefixedVisitor governor_visitor(v, "governor_");
  governor.visit(governor_visitor);
}

PlannerComponentParameters completed(PlannerComponentParameters parameters) {
  if (parameters.govern_speed &&
      (parameters.planner.view != "rolling" || parameters.planner.fire_while_moving)) {
    throw ConfigError("govern_speed needs view 'rolling', and fire_while_moving false");
  }
  if (parameters.unsure_threshold > parameters.crop_threshold) {
    throw ConfigError("unsure_threshold must not be above crop_threshold");
  }
  if (parameters.species_file.empty()) return parameters;
  planning::HarmfulnessParameters& harmfulness = parameters.harmfulness;
  harmfulness.species.clear();
  harmfulness.beta.clear();
  harmfulness.class_weight.clear();
  const field::SpeciesTable table = load_species(parameters.species_file);
  for (const field::Species& species : table.all()) {
    if (species.kind != field::PlantKind::kWeed) continue;
    harmfulness.species.push_back(species.name);
    harmfulness.beta.push_back(species.beta);
    harmfulness.class_weight.push_back(species.priority);
  }
  return parameters;
}

}  // namespace furrow::components
