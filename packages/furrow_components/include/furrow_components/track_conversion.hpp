#pragma once

#include "furrow_components/species_names.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_tracking/track.hpp"

namespace furrow::components {

/// A track as the tracker publishes it. `species` is the table of its species; those of less than
/// 0.5 % are left out and count as unknown.
[[nodiscard]] furrow_msgs::msg::Track to_msg(const tracking::Track& track,
                                             const SpeciesNames& species);

}  // namespace furrow::components
