#include "perception_parameters.hpp"

namespace furrow::components {

void PerceptionParameters::visit(ParameterVisitor& v) {
  detector.visit(v);
  v.visit({.name = "ground_distance_m",
           .unit = "m",
           .description = "distance from camera to ground where depth is unknown",
           .min = 0.05,
           .max = 20.0},
          ground_distance_m);
  v.visit({.name = "min_score",
           .description = "instances with a lower score are not published",
           .min = 0.0,
           .max = 1.0},
          min_score);
  visit_depth(v);
  v.visit({.name = "rectified",
           .description = "true: the images are free of distortion, as those of image_proc, "
                          "although camera_info has coefficients"},
          rectified);
  PrefixedVisitor growth_visitor(v, "stage_");
  growth.visit(growth_visitor);
}

void PerceptionParameters::visit_depth(ParameterVisitor& v) {
  v.visit({.name = "use_depth",
           .description = "false: images are used without depth, at ground_distance_m"},
          use_depth);
  v.visit({.name = "without_depth",
           .description = "an image for which no depth image comes in time: drop, or ground for "
                          "ground_distance_m as the depth everywhere",
           .choices = {"drop", "ground"}},
          without_depth);
  v.visit({.name = "depth_unit_m",
           .unit = "m",
           .description = "of a depth image of integers (16UC1)",
           .min = 1e-6,
           .max = 0.1},
          depth_unit_m);
  v.visit({.name = "depth_tolerance_s",
           .unit = "s",
           .description = "largest difference between the stamps of image and depth, below half "
                          "the period of the images",
           .min = 0.0,
           .max = 1.0},
          depth_tolerance_s);
  v.visit({.name = "depth_patience_s",
           .unit = "s",
           .description = "how long an image waits for its depth; noticed with the next message of "
                          "the camera",
           .min = 0.0,
           .max = 10.0},
          depth_patience_s);
}

}  // namespace furrow::components
