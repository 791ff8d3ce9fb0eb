#pragma once

#include <algorithm>
#include <vector>

#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {

/// A weed of 200 mm2 at a place in F.
inline Observation seen_at(double x_m, double y_m, double radius_m = 0.01) {
  Observation observation;
  observation.p_F_m = {x_m, y_m};
  observation.covariance_F_m2 = Eigen::Matrix2d::Identity() * 1e-6;
  observation.radius_m = radius_m;
  observation.area_mm2 = 200.0;
  observation.class_probability = {0.1, 0.9};
  return observation;
}

/// A view by a standing camera that sees [-1, 1] x [-1, 1] m.
inline View view_at(double t_s) {
  View view;
  view.stamp = Time::from_seconds(t_s);
  view.visible = *GroundRegion::from_bounds({-1.0, -1.0}, {1.0, 1.0});
  return view;
}

using Observations = std::vector<Observation>;

/// Index into the species table of the most probable one; -1: no view named a species.
inline int most_probable_species(const Track& track) {
  const auto& probability = track.species_probability;
  const auto best = std::ranges::max_element(probability);
  if (best == probability.end() || !(*best > 0.0F)) return -1;
  return static_cast<int>(best - probability.begin());
}

}  // namespace furrow::tracking
