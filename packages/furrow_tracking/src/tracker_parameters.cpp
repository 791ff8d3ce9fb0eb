#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {

void TrackerParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "association",
           .description = "how observations are matched to tracks",
           .choices = {"dynamic_radius", "fixed_radius", "iou"}},
          association);
  v.visit({.name = "min_radius_m",
           .unit = "m",
           .description = "dynamic_radius: least radius that a plant is given for matching",
           .min = 1e-4,
           .max = 1.0},
          min_radius_m);
  v.visit({.name = "max_radius_m",
           .unit = "m",
           .description = "dynamic_radius: greatest radius that a plant is given for matching",
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
           .description = "views after which a track is believed",
           .min = 1,
           .max = 100},
          confirm_matches);
  v.visit({.name = "tentative_misses",
           .description = "misses in a row that end a track not yet confirmed",
           .min = 1,
           .max = 100},
          tentative_misses);
  v.visit({.name = "confirmed_misses",
           .description = "misses in a row that end a confirmed track",
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
  v.visit({.name = "keep_distance_m",
           .unit = "m",
           .description = "distance from the robot beyond which a track ends",
           .min = 0.5,
           .max = 1000.0},
          keep_distance_m);
  v.visit({.name = "max_tracks",
           .description = "greatest number of living tracks; beyond it the farthest end",
           .min = 1,
           .max = 100000},
          max_tracks);
  v.visit({.name = "max_observations",
           .description = "observations of one view that are looked at",
           .min = 1,
           .max = 100000},
          max_observations);
  v.visit({.name = "duplicate_ratio",
           .description = "distance, as a share of the smaller radius, within which two "
                          "observations or tracks are the same plant; 0: never",
           .min = 0.0,
           .max = 1.0},
          duplicate_ratio);
  v.visit({.name = "position_floor_m",
           .unit = "m",
           .description = "least standard deviation that a track's position may claim",
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
  v.visit({.name = "outlier_sigma",
           .description = "standard deviations from which on an observation's weight is reduced",
           .min = 1.0,
           .max = 100.0},
          outlier_sigma);
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
           .description = "bound of the collected evidence of class",
           .min = 0.1,
           .max = 30.0},
          class_max_log_odds);
  v.visit({.name = "size_memory_views",
           .description = "views over which radius and area are averaged",
           .min = 1.0,
           .max = 1000.0},
          size_memory_views);
  v.visit({.name = "follow_pose",
           .description = "whether tracks go along when the pose is corrected, as by GNSS after "
                          "an outage"},
          follow_pose);
  v.visit({.name = "follow_behind_m",
           .unit = "m",
           .description = "how far behind the robot's base tracks do so no longer",
           .min = -100.0,
           .max = 100.0},
          follow_behind_m);
  rows.visit(v);
}

}  // namespace furrow::tracking
