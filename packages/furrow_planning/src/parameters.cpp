#include "furrow_planning/parameters.hpp"

namespace furrow::planning {

void PlannerParameters::visit(ParameterVisitor& v) {
  visit_method(v);
  visit_motion(v);
  visit_sprays(v);
  visit_search(v);
}

void PlannerParameters::visit_method(ParameterVisitor& v) {
  v.visit({.name = "planner",
           .description = "route planner: greedy nearest feasible, nOTSP, the paper's permutation, "
                          "the exact best routes, or exact routes of footprints placed anywhere",
           .choices = {"greedy", "notsp", "permutation", "exact", "footprint"}},
          planner);
  v.visit({.name = "assignment",
           .description = "how targets are divided among the axes",
           .choices = {"distance", "static", "dynamic", "joint"}},
          assignment);
  v.visit({.name = "view", .description = "observation model", .choices = {"rolling", "segment"}},
          view);
}

void PlannerParameters::visit_motion(ParameterVisitor& v) {
  v.visit({.name = "kinematics",
           .description =
               "motion of the axes: full velocity at once, or rest to rest within the limits",
           .choices = {"velocity", "trapezoid"}},
          kinematics);
  v.visit({.name = "rho",
           .description = "cutoff on the feasibility Gamma of a move",
           .min = 0.5,
           .max = 0.999},
          rho);
  v.visit({.name = "omega",
           .unit = "1/s",
           .description = "steepness of the logistic function of the feasibility",
           .min = 0.1,
           .max = 1e6},
          omega);
  v.visit({.name = "speed_source",
           .description = "robot speed to plan with: the nominal one or the measured one",
           .choices = {"nominal", "measured"}},
          speed_source);
  v.visit({.name = "speed_mps",
           .unit = "m/s",
           .description = "nominal robot speed",
           .min = 0.01,
           .max = 10.0},
          speed_mps);
  v.visit({.name = "dwell_s",
           .unit = "s",
           .description = "time for which the axis rests during a spray",
           .min = 0.0,
           .max = 10.0},
          dwell_s);
  v.visit({.name = "settle_s",
           .unit = "s",
           .description = "time between the end of a move and a spray",
           .min = 0.0,
           .max = 10.0},
          settle_s);
}

void PlannerParameters::visit_sprays(ParameterVisitor& v) {
  v.visit({.name = "footprint_radius_m",
           .unit = "m",
           .description = "radius of a spray on the ground",
           .min = 0.001,
           .max = 1.0},
          footprint_radius_m);
  v.visit({.name = "placement_margin_m",
           .unit = "m",
           .description = "a stem this near the rim of a footprint does not count as treated",
           .min = 0.0,
           .max = 1.0},
          placement_margin_m);
  v.visit(
      {.name = "centre_preference",
       .description = "share of its weight that a target loses from the centre of the footprint "
                      "to the rim, in the choice among plans",
       .min = 0.0,
       .max = 1.0},
      centre_preference);
  v.visit({.name = "protection_zone_mm",
           .unit = "mm",
           .description = "distance that the rim of a footprint keeps from the stem of a crop",
           .min = 0.0,
           .max = 1000.0},
          protection_zone_mm);
  v.visit({.name = "fire_while_moving",
           .description = "whether a nozzle may fire in passing, during a move"},
          fire_while_moving);
  v.visit(
      {.name = "min_weight", .description = "targets of less weight are left standing", .min = 0.0},
      min_weight);
  v.visit({.name = "commit_s",
           .unit = "s",
           .description = "a stop that departs within this time is committed: it no longer changes",
           .min = 0.0,
           .max = 60.0},
          commit_s);
  v.visit({.name = "segment_length_m",
           .unit = "m",
           .description = "length of a segment of the segment view",
           .min = 0.05,
           .max = 100.0},
          segment_length_m);
}

void PlannerParameters::visit_search(ParameterVisitor& v) {
  v.visit({.name = "notsp_targets",
           .description = "next targets among which nOTSP looks for a tour at each step",
           .min = 1,
           .max = 8},
          notsp_targets);
  v.visit({.name = "permutation_targets",
           .description = "targets that the permutation planner takes at a time",
           .min = 1,
           .max = 9},
          permutation_targets);
  v.visit({.name = "improvement_rounds",
           .description =
               "rounds in which the footprint planner improves its routes, and rounds in which it "
               "then pursues missed targets",
           .min = 0,
           .max = 1000},
          improvement_rounds);
  v.visit({.name = "threads",
           .description = "threads for planners that treat the axes one by one",
           .min = 1,
           .max = 64},
          threads);
  v.visit({.name = "max_targets",
           .description = "more targets at once are refused",
           .min = 1,
           .max = 1e6},
          max_targets);
}

}  // namespace furrow::planning
