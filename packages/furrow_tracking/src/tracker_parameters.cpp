#include "furrow_core/error.hpp"
#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {

void TrackerParameters::check() const {
  validate_parameters(*this);
  if (min_radius_m > max_radius_m) throw ConfigError("min_radius_m is greater than max_radius_m");
  if (match_score > birth_score) throw ConfigError("match_score is greater than birth_score");
}

void TrackerParameters::visit(ParameterVisitor& v) {
  visit_association(v);
  visit_lifetime(v);
  visit_limits(v);
  visit_position(v);
  visit_repeats(v);
  visit_class(v);
  visit_species(v);
  visit_pose(v);
  rows.visit(v);
}

void TrackerParameters::visit_association(ParameterVisitor& v) {
  v.visit({.name = "association",
           .description = "how observations are matched to tracks",
           .choices = {"dynamic_radius", "fixed_radius", "iou"}},
          association);
  v.visit({.name = "min_radius_m",
           .unit = "m",
           .description = "dynamic_radius: least matching radius of a plant",
           .min = 1e-4,
           .max = 1.0},
          min_radius_m);
  v.visit({.name = "max_radius_m",
           .unit = "m",
           .description = "dynamic_radius: greatest matching radius of a plant",
           .min = 1e-4,
           .max = 1.0},
          max_radius_m);
  v.visit({.name = "displacement_gain",
           .description = "dynamic_radius: how much recent displacement widens the radius",
           .min = 0.0,
           .max = 10.0},
          displacement_gain);
  v.visit({.name = "uncertainty_gain",
           .description = "dynamic_radius: standard deviations of position that widen the radius",
           .min = 0.0,
           .max = 10.0},
          uncertainty_gain);
  v.visit({.name = "size_weight",
           .description = "dynamic_radius: how much a change of size by a factor e adds to the "
                          "cost, as a share of it; 0: size does not matter",
           .min = 0.0,
           .max = 10.0},
          size_weight);
  v.visit({.name = "fixed_radius_m",
           .unit = "m",
           .description = "fixed_radius: greatest distance of a match",
           .min = 1e-4,
           .max = 1.0},
          fixed_radius_m);
  v.visit(
      {.name = "min_iou", .description = "iou: least overlap of a match", .min = 1e-3, .max = 1.0},
      min_iou);
}

void TrackerParameters::visit_lifetime(ParameterVisitor& v) {
  v.visit({.name = "birth_score",
           .description = "least score of an observation that begins a track",
           .min = 0.0,
           .max = 1.0},
          birth_score);
  v.visit({.name = "match_score",
           .description = "least score of an observation that is matched to a track",
           .min = 0.0,
           .max = 1.0},
          match_score);
  v.visit({.name = "confirm_matches",
           .description = "matches after which a track is confirmed",
           .min = 1,
           .max = 100},
          confirm_matches);
  v.visit({.name = "tentative_misses",
           .description = "misses in a row after which a tentative track is deleted",
           .min = 1,
           .max = 100},
          tentative_misses);
  v.visit({.name = "confirmed_misses",
           .description = "misses in a row after which a confirmed track is deleted",
           .min = 1,
           .max = 1000},
          confirmed_misses);
  v.visit(
      {.name = "visible_margin_m",
       .unit = "m",
       .description = "how far inside the visible ground a plant must stand for a miss to count",
       .min = 0.0,
       .max = 1.0},
      visible_margin_m);
}

void TrackerParameters::visit_limits(ParameterVisitor& v) {
  v.visit({.name = "keep_distance_m",
           .unit = "m",
           .description = "distance from the robot beyond which a track is deleted",
           .min = 0.5,
           .max = 1000.0},
          keep_distance_m);
  v.visit({.name = "max_tracks",
           .description = "greatest number of tracks; above it the farthest ones are deleted",
           .min = 1,
           .max = 100000},
          max_tracks);
  v.visit({.name = "max_observations",
           .description = "greatest number of observations used from one view",
           .min = 1,
           .max = 100000},
          max_observations);
  v.visit({.name = "duplicate_ratio",
           .description = "distance, as a share of the smaller radius, within which two "
                          "observations or tracks are the same plant; 0: never",
           .min = 0.0,
           .max = 1.0},
          duplicate_ratio);
}

void TrackerParameters::visit_position(ParameterVisitor& v) {
  v.visit({.name = "position_floor_m",
           .unit = "m",
           .description = "lower bound of the standard deviation of a track's position",
           .min = 0.0,
           .max = 0.1},
          position_floor_m);
  v.visit(
      {.name = "drift_m_per_sqrt_s",
       .unit = "m/sqrt(s)",
       .description = "random walk of a plant's position: leaves in the wind, drift of the pose",
       .min = 0.0,
       .max = 0.1},
      drift_m_per_sqrt_s);
  v.visit({.name = "truncated_sigma_ratio",
           .description = "standard deviation, as a share of the radius, added to the stem of a "
                          "plant cut by the image's border",
           .min = 0.0,
           .max = 10.0},
          truncated_sigma_ratio);
  v.visit({.name = "max_pose_sigma_m",
           .unit = "m",
           .description = "standard deviation of the pose that may differ from view to view; a "
                          "greater one is drift, which views share",
           .min = 0.0,
           .max = 10.0},
          max_pose_sigma_m);
  v.visit(
      {.name = "outlier_sigma",
       .description = "standard deviations beyond which the weight of an observation is reduced",
       .min = 1.0,
       .max = 100.0},
      outlier_sigma);
}

void TrackerParameters::visit_repeats(ParameterVisitor& v) {
  v.visit({.name = "repeat_distance_m",
           .unit = "m",
           .description = "a view from within this distance of the last one is no new evidence; 0: "
                          "every view is",
           .min = 0.0,
           .max = 1.0},
          repeat_distance_m);
}

void TrackerParameters::visit_class(ParameterVisitor& v) {
  v.visit({.name = "class_floor",
           .description = "least probability that one view may give a class",
           .min = 1e-6,
           .max = 0.5},
          class_floor);
  v.visit({.name = "class_evidence_weight",
           .description = "share of a view's evidence of class that counts; below 1 because views "
                          "of one plant are alike",
           .min = 0.0,
           .max = 1.0},
          class_evidence_weight);
  v.visit({.name = "class_truncated_weight",
           .description = "share of that for a plant cut by the image's border",
           .min = 0.0,
           .max = 1.0},
          class_truncated_weight);
  v.visit({.name = "class_max_log_odds",
           .description = "bound on the accumulated log odds of the class",
           .min = 0.1,
           .max = 30.0},
          class_max_log_odds);
  v.visit({.name = "size_memory_views",
           .description = "views over which radius and area are averaged",
           .min = 1.0,
           .max = 1000.0},
          size_memory_views);
}

void TrackerParameters::visit_species(ParameterVisitor& v) {
  v.visit({.name = "species_confusion",
           .description = "share of views whose species says nothing about the true one",
           .min = 1e-3,
           .max = 1.0},
          species_confusion);
  v.visit({.name = "species_alternatives",
           .description = "number of species that a plant may be of, those without a name included",
           .min = 1,
           .max = 1000},
          species_alternatives);
  v.visit({.name = "species_view_correlation",
           .description = "correlation between the errors of species in two views of a plant; at 1 "
                          "further views add no evidence",
           .min = 0.0,
           .max = 1.0},
          species_view_correlation);
}

void TrackerParameters::visit_pose(ParameterVisitor& v) {
  v.visit({.name = "follow_pose",
           .description = "whether tracks move with corrections of the pose, such as the first "
                          "GNSS fix after an outage"},
          follow_pose);
  v.visit({.name = "follow_behind_m",
           .unit = "m",
           .description = "distance behind the robot's base from which tracks keep their place",
           .min = -100.0,
           .max = 100.0},
          follow_behind_m);
}

}  // namespace furrow::tracking
