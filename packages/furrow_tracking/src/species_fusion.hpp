#pragma once

#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking {

/// Adds a view's species to a track and updates its species_probability. No effect where the view
/// names none.
///
/// Confusion model: a share c of views (species_confusion) says nothing about the true species. A
/// view with probability p for one of n species then gives it the likelihood (1 - c) p + c / n.
/// Against a species that is not named, the log odds are log(1 + (1 - c) n p / c).
/// Views of one plant are alike: with correlation r between their errors, m views count as
/// m / (1 + (m - 1) r) independent ones (the design effect; Kish 1965). A view that the image's
/// border cuts counts by class_truncated_weight. The prior is uniform.
void add_species_evidence(Track& track, const Observation& seen,
                          const TrackerParameters& parameters);

/// As if the views of `other` were views of `kept`.
void merge_species_evidence(Track& kept, const Track& other, const TrackerParameters& parameters);

}  // namespace furrow::tracking
