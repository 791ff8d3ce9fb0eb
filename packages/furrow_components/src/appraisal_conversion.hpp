#pragma once

#include <vector>

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_planning/harmfulness.hpp"

namespace furrow::components {

/// The weed species of a track, each given that it is a weed. `shares` is replaced; its names are
/// views of the track's.
void weed_species(const furrow_msgs::msg::Track& track,
                  std::vector<planning::SpeciesShare>& shares);

/// What a decision about the track says of its worth.
[[nodiscard]] furrow_msgs::msg::Appraisal appraisal(
    const planning::Harmfulness& harmfulness, const furrow_msgs::msg::Track& track,
    const planning::HarmfulnessParameters& parameters);

}  // namespace furrow::components
